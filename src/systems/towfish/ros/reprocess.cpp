// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/reprocess.hpp"

#include <fmt/format.h>

#include "bag/topics.hpp"
#include "bag/tum.hpp"
#include "ros/estimate_messages.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "systems/towfish/graph/estimators.hpp"
#include "systems/towfish/ros/ingest.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kBatch = 256;  // measurements handed to an estimator at once

/// One estimator on its way through a bag.
class Lane {
 public:
  Lane(const std::string& name, const Settings& settings, BagOutput& bag, const std::string& tum_path)
      : name_(name),
        settings_(settings),
        estimator_(towfish::makeAnyEstimator(name, settings.estimation)),
        bag_(bag),
        tum_(tum_path) {}

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
    for (const auto& estimate : output_.solutions) tum_.write(estimate);
    for (const auto& audit : output_.audits) ++report_.verdicts[static_cast<std::size_t>(audit.verdict)];
    report_.estimates += output_.solutions.size();
    forEachMessage(
        name_, "odometry", output_, frame, settings_,
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

class TowfishRun final : public BagRun {
 public:
  TowfishRun(const Settings& settings, SensorTopics topics, const std::vector<std::string>& estimators,
             const RunOutput& out)
      : topics_(std::move(topics)),
        ingest_(settings, out.transforms, [this](const Measurement& z) { batch_.push_back(z); }) {
    for (const auto& name : estimators)
      lanes_.push_back(std::make_unique<Lane>(name, settings, out.bag, fmt::format("{}.{}.tum", out.stem, name)));
  }

  bool isSensor(const BagConnection& connection) const override {
    return connection.topic == topics_.fix || connection.topic == topics_.imu || connection.topic == topics_.twist;
  }

  void take(const BagReader& bag, const BagMessage& message) override {
    const std::string& topic = message.connection->topic;
    if (topic == topics_.fix && bag.get(message, fix_)) ingest_.take(fix_);
    if (topic == topics_.imu && bag.get(message, imu_)) ingest_.take(imu_);
    if (topic == topics_.twist && bag.get(message, twist_)) ingest_.take(twist_);
    if (batch_.size() >= kBatch) feed();
  }

  void finish(ReprocessReport& report) override {
    ingest_.finish();
    feed();
    for (auto& lane : lanes_) lane->finish(origin());
    for (int i = 0; i < Ingest::kSources; ++i)
      report.sensors[Ingest::kNames[static_cast<std::size_t>(i)]] = ingest_.counts(static_cast<Ingest::Source>(i));
    for (const auto& lane : lanes_) report.estimators[lane->name()] = lane->report();
  }

  void commit() override {
    for (auto& lane : lanes_) lane->commit();
  }
  const std::optional<LocalFrame>& frame() const override { return ingest_.frame(); }

 private:
  const LocalFrame* origin() const { return frame() ? &*frame() : nullptr; }
  void feed() {
    for (auto& lane : lanes_) lane->process(batch_, origin());
    batch_.clear();
  }

  SensorTopics topics_;
  std::vector<Measurement> batch_;
  Ingest ingest_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  sensor_msgs::NavSatFix fix_;
  sensor_msgs::Imu imu_;
  geometry_msgs::TwistWithCovarianceStamped twist_;
};

class TowfishSystem final : public ReprocessSystem {
 public:
  explicit TowfishSystem(const std::string& config) : settings_(Settings::fromFile(config)) {}

  void require(const std::string& estimator) const override {
    if (!towfish::makeAnyEstimator(estimator, settings_.estimation))
      throw std::runtime_error(
          fmt::format("'{}' is no estimator; known are {}", estimator, fmt::join(towfish::estimatorNames(), ", ")));
  }
  std::unique_ptr<BagRun> begin(const BagReader& source, const std::string& file,
                                const std::vector<std::string>& estimators, const RunOutput& out) const override {
    return std::make_unique<TowfishRun>(settings_, findTopics(source.connections(), settings_, file), estimators, out);
  }
  const MapSettings& map() const override { return settings_; }

 private:
  Settings settings_;
};

}  // namespace

std::unique_ptr<ReprocessSystem> makeTowfishSystem(const std::string& config) {
  return std::make_unique<TowfishSystem>(config);
}

}  // namespace sas_motion::ros_side
