// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/reprocess.hpp"

#include <fmt/format.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "bag/bag_output.hpp"
#include "bag/bag_reader.hpp"
#include "bag/topics.hpp"
#include "bag/tum.hpp"
#include "ros/solution_messages.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kBatch = 256;  // readings handed to an estimator at once

/// What to do with the messages of a connection.
struct Route {
  enum Kind { kAnother, kOfAnEarlierRun, kTransforms, kSensor } kind = kAnother;
  std::vector<std::size_t> sources = {};  // of sensors: several may read one topic
  std::optional<std::uint32_t> output;    // its connection there
};

std::vector<Route> routesOf(const std::vector<BagConnection>& connections, const std::vector<MessageSource>& sources,
                            const std::vector<std::string>& estimators, const std::string& file) {
  std::vector<Route> routes(connections.size());
  for (const auto& connection : connections) {
    Route& route = routes[connection.index];
    if (connection.type == "tf2_msgs/TFMessage") route.kind = Route::kTransforms;
    if (isEstimate(connection.topic, estimators)) route.kind = Route::kOfAnEarlierRun;
    for (std::size_t i = 0; i < sources.size(); ++i)
      if (sources[i].topic == connection.topic && sources[i].md5 == connection.md5sum) route.sources.push_back(i);
    if (route.sources.empty()) continue;
    if (route.kind == Route::kOfAnEarlierRun)
      throw std::runtime_error(
          fmt::format("{}: topic {} is a sensor's, and an estimator would write it too; leave that estimator out", file,
                      connection.topic));
    route.kind = Route::kSensor;
  }
  return routes;
}

/// Where one estimator's answers go.
class LaneWriter {
 public:
  LaneWriter(const std::string& name, const MapSettings& settings, BagOutput& bag, const std::string& tum)
      : name_(name), settings_(settings), bag_(bag), tum_(tum) {}

  void write(const Output& output) {
    for (const auto& solution : output.solutions) tum_.write(solution);
    for (const auto& audit : output.audits) ++report_.verdicts[static_cast<std::size_t>(audit.verdict)];
    report_.estimates += output.solutions.size();
    forEachMessage(name_, output, settings_, [this](const std::string& topic, ros::Time time, const auto& message) {
      bag_.write(topic, time, message);
    });
  }
  void close(const LaneReport& lane) {
    report_.lane = lane;
    tum_.close();
  }
  void commit() { tum_.commit(); }
  const ReprocessReport::PerEstimator& report() const { return report_; }

 private:
  std::string name_;
  const MapSettings& settings_;
  BagOutput& bag_;
  TumFile tum_;
  ReprocessReport::PerEstimator report_;
};

/// A bag on its way through a system's estimators.
class BagRun {
 public:
  BagRun(const System& system, const std::vector<std::string>& estimators, const tf2::BufferCore& transforms,
         BagOutput& bag, const std::string& stem)
      : run_(system.begin(estimators, transforms, false)) {
    for (const auto& name : estimators)
      writers_.push_back(std::make_unique<LaneWriter>(name, system.map, bag, fmt::format("{}.{}.tum", stem, name)));
  }

  void take(const Route& route, const BagReader& bag, const BagMessage& message) {
    for (const std::size_t source : route.sources)
      bag.read(message, [&](ros::serialization::IStream& stream) { run_->take(source, stream); });
    if (run_->session().unfed() < kBatch) return;
    run_->session().feed();
    drain();
  }

  void finish(const std::string& file, const std::vector<MessageSource>& topics, ReprocessReport& report) {
    run_->finish();
    drain();
    for (std::size_t i = 0; i < topics.size(); ++i)
      if (!topics[i].topic.empty() || topics[i].need != MessageSource::Need::NamedAlone)
        report.sensors[topics[i].name] = run_->inbox().counts(i);
    bool silent = true;  // no answer, and no reason from any estimator
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      writers_[i]->close(run_->session().report(i));
      report.estimators[run_->session().names()[i]] = writers_[i]->report();
      silent &= writers_[i]->report().estimates == 0 && writers_[i]->report().lane.failure.empty();
    }
    const std::string waits_for = run_->waitsFor();
    if (silent && !waits_for.empty())
      throw std::runtime_error(fmt::format("{}: estimation never started: {}", file, waits_for));
    if (silent)
      throw std::runtime_error(
          fmt::format("{}: no estimator gave an answer, as none could start from the measurements; "
                      "look at enabled, datum and time_offset in the configuration",
                      file));
    report.warnings = run_->warnings();
  }

  void commit() {
    for (auto& writer : writers_) writer->commit();
  }
  const std::optional<LocalFrame>& map() const { return run_->frame().map; }

 private:
  void drain() {
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      output_.clear();
      run_->session().takeSettled(i, run_->frame(), output_);
      writers_[i]->write(output_);
    }
  }

  std::unique_ptr<SystemRun> run_;
  std::vector<std::unique_ptr<LaneWriter>> writers_;
  Output output_;
};

}  // namespace

ReprocessReport reprocess(const std::string& input, const std::string& folder,
                          const std::vector<std::string>& estimators, const System& system,
                          const std::function<void(double)>& progress) {
  BagReader source(input);
  const std::filesystem::path out = std::filesystem::path(folder) / std::filesystem::path(input).filename();
  if (std::filesystem::exists(out) && std::filesystem::equivalent(out, input))
    throw std::runtime_error(
        fmt::format("{}: the output would replace the input; choose another folder with -o", input));

  ReprocessReport report;
  report.input = input;
  report.output = out;
  const auto topics = findTopics(source.connections(), system.sources, input);
  std::vector<Route> routes = routesOf(source.connections(), topics, estimators, input);
  BagOutput bag(out);
  tf2::BufferCore transforms;
  BagRun run(system, estimators, transforms, bag, (out.parent_path() / out.stem()).string());

  double done = 0;
  bool datum_written = false;
  tf2_msgs::TFMessage tf;
  while (const BagMessage* m = source.next()) {
    ++report.messages;
    Route& route = routes[m->connection->index];
    if (route.kind == Route::kOfAnEarlierRun) continue;
    if (!route.output) route.output = bag.connect(*m->connection);
    bag.write(*route.output, m->time, m->bytes);
    if (route.kind == Route::kTransforms && source.get(*m, tf))
      for (const auto& T : tf.transforms)
        transforms.setTransform(T, "bag", bareTopic(m->connection->topic) == "tf_static");
    if (route.kind == Route::kSensor) run.take(route, source, *m);
    if (!datum_written && run.map()) {
      bag.writeLatched("datum", m->time, fixAt(run.map()->datum(), m->time, system.map.map_frame));
      datum_written = true;
    }
    if (report.messages % 1024 == 0) {
      const double now = (m->time - source.begin()).toSec();
      progress(now - done);
      done = now;
    }
  }
  report.duration = (source.end() - source.begin()).toSec();
  run.finish(input, topics, report);
  bag.commit();
  run.commit();
  progress(report.duration - done);
  return report;
}

}  // namespace sas_motion::ros_side
