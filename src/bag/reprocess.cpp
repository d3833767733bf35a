// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/bag/reprocess.hpp"

#include <fmt/format.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>
#include <optional>

#include "sas_motion/bag/bag_output.hpp"
#include "sas_motion/bag/bag_reader.hpp"
#include "sas_motion/bag/topics.hpp"
#include "sas_motion/bag/tum.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/ros/estimate_messages.hpp"
#include "sas_motion/smoothers/factor_graph/estimators.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kBatch = 256;  // measurements handed to an estimator at once

/// One estimator on its way through a bag.
class Lane {
 public:
  Lane(const std::string& name, const Settings& settings, BagOutput& bag, const std::string& tum_path)
      : name_(name), settings_(settings), estimator_(towfish::makeAnyEstimator(name, settings.estimation)), bag_(bag), tum_(tum_path) {}

  void process(const std::vector<Measurement>& measurements, const LocalFrame* frame) {
    const double begin = cpuSeconds();
    for (const auto& z : measurements) estimator_->process(z, output_);
    report_.seconds += cpuSeconds() - begin;
    report_.measurements += measurements.size();
    drain(frame);
  }

  void finish(const LocalFrame* frame) {
    const double begin = cpuSeconds();
    estimator_->finish(output_);
    report_.seconds += cpuSeconds() - begin;
    report_.failure = estimator_->failure();
    drain(frame);
    tum_.close();
  }

  void commit() { tum_.commit(); }

  const std::string& name() const { return name_; }
  const ReprocessReport::PerEstimator& report() const { return report_; }

 private:
  void drain(const LocalFrame* frame) {
    for (const auto& estimate : output_.estimates) tum_.write(estimate);
    for (const auto& audit : output_.audits) ++report_.verdicts[static_cast<std::size_t>(audit.verdict)];
    report_.estimates += output_.estimates.size();
    forEachMessage(name_, "odometry", output_, frame, settings_,
                   [this](const std::string& topic, ros::Time time, const auto& message) { bag_.write(topic, time, message); });
    output_.clear();
  }

  std::string name_;
  const Settings& settings_;
  std::unique_ptr<towfish::Estimator> estimator_;
  BagOutput& bag_;
  TumFile tum_;
  towfish::Output output_;
  ReprocessReport::PerEstimator report_;
};

/// What to do with the messages of a connection.
struct Route {
  enum Kind { kAnother, kOfAnEarlierRun, kTransforms, kFix, kImu, kTwist } kind = kAnother;
  std::optional<std::uint32_t> output;  // its connection there
};

std::vector<Route> routesOf(const std::vector<BagConnection>& connections, const SensorTopics& topics, const std::vector<std::string>& estimators) {
  std::vector<Route> routes(connections.size());
  for (const auto& connection : connections) {
    auto& kind = routes[connection.index].kind;
    if (connection.topic == topics.twist) kind = Route::kTwist;
    if (connection.topic == topics.imu) kind = Route::kImu;
    if (connection.topic == topics.fix) kind = Route::kFix;
    if (topics.transforms.count(connection.topic)) kind = Route::kTransforms;
    if (isEstimate(connection.topic, estimators)) kind = Route::kOfAnEarlierRun;
  }
  return routes;
}

}  // namespace

ReprocessReport reprocess(const std::string& input, const std::string& folder, const std::vector<std::string>& estimators, const Settings& settings,
                          const std::function<void(double)>& progress) {
  BagReader source(input);
  std::vector<Route> routes = routesOf(source.connections(), findTopics(source.connections(), settings, input), estimators);
  const std::filesystem::path out = std::filesystem::path(folder) / std::filesystem::path(input).filename();
  if (std::filesystem::exists(out) && std::filesystem::equivalent(out, input))
    throw std::runtime_error(fmt::format("{}: the output would replace the input; choose another folder with -o", input));

  ReprocessReport report;
  report.input = input;
  report.output = out;
  BagOutput bag(out);
  tf2::BufferCore transforms;
  std::vector<std::unique_ptr<Lane>> lanes;
  for (const auto& name : estimators)
    lanes.push_back(std::make_unique<Lane>(name, settings, bag, fmt::format("{}.{}.tum", (out.parent_path() / out.stem()).string(), name)));

  std::vector<Measurement> batch;
  Ingest ingest(settings, transforms, [&](const Measurement& z) { batch.push_back(z); });
  const auto frame = [&] { return ingest.frame() ? &*ingest.frame() : nullptr; };
  const auto feed = [&] {
    for (auto& lane : lanes) lane->process(batch, frame());
    batch.clear();
  };

  double done = 0;
  bool datum_written = false;
  tf2_msgs::TFMessage tf;
  sensor_msgs::NavSatFix fix;
  sensor_msgs::Imu imu;
  geometry_msgs::TwistWithCovarianceStamped twist;
  while (const BagMessage* m = source.next()) {
    ++report.messages;
    Route& route = routes[m->connection->index];
    if (route.kind == Route::kOfAnEarlierRun) continue;
    if (!route.output) route.output = bag.connect(*m->connection);
    bag.write(*route.output, m->time, m->bytes);
    if (route.kind == Route::kTransforms && source.get(*m, tf)) {
      for (const auto& T : tf.transforms) transforms.setTransform(T, "bag", bareTopic(m->connection->topic) == "tf_static");
    } else if (route.kind == Route::kFix && source.get(*m, fix)) {
      ingest.take(fix);
    } else if (route.kind == Route::kImu && source.get(*m, imu)) {
      ingest.take(imu);
    } else if (route.kind == Route::kTwist && source.get(*m, twist)) {
      ingest.take(twist);
    }
    if (!datum_written && ingest.frame()) {
      bag.writeLatched("datum", m->time, datumOf(*ingest.frame(), settings, m->time));
      datum_written = true;
    }
    if (batch.size() >= kBatch) feed();
    if (report.messages % 1024 == 0) {
      const double now = (m->time - source.begin()).toSec();
      progress(now - done);
      done = now;
    }
  }
  ingest.finish();
  feed();
  for (auto& lane : lanes) lane->finish(frame());
  report.duration = (source.end() - source.begin()).toSec();
  bag.commit();
  for (auto& lane : lanes) lane->commit();
  progress(report.duration - done);
  report.sensors = {{"fix", ingest.counts(Ingest::kFix)}, {"imu", ingest.counts(Ingest::kImu)}, {"twist", ingest.counts(Ingest::kTwist)}};
  for (const auto& lane : lanes) report.estimators[lane->name()] = lane->report();
  return report;
}

}  // namespace sas_motion::ros_side
