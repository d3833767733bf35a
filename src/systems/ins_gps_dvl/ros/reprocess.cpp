// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/reprocess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bag/topics.hpp"
#include "bag/tum.hpp"
#include "ros/estimate_messages.hpp"
#include "sas_motion/session/output_rate.hpp"
#include "systems/ins_gps_dvl/ros/ingest.hpp"
#include "systems/ins_gps_dvl/ros/remarks.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kBatch = 256;  // readings handed to an estimator at once

/// Where one estimator's answers go.
class Writer {
 public:
  Writer(const std::string& name, const InsSettings& settings, const RunOutput& out)
      : name_(name),
        settings_(settings),
        rate_(settings.estimation.output_rate),
        bag_(out.bag),
        tum_(fmt::format("{}.{}.tum", out.stem, name)) {}

  /// Nothing starts without a fix, so that there is a frame where there are solutions.
  void drain(ins::Output& output, const std::optional<LocalFrame>& frame, const Vector<3>& base_lever_body) {
    inTimeOrder(
        output.solutions, output.audits,
        [&](const ins::NavigationSolution& solution) {
          if (rate_.due(solution.stamp)) write(movedBy(solution, base_lever_body), *frame);
        },
        [&](const ins::Audit& audit) {
          ++report_.verdicts[static_cast<std::size_t>(audit.verdict)];
          bag_.write(name_ + "/update", timeOf(audit.stamp), updateOf(audit));
        });
    output.clear();
  }

  void finish(const ins::Lane& lane) {
    report_.measurements = lane.readings;
    report_.seconds = lane.seconds;
    if (lane.estimator) report_.failure = lane.estimator->failure();
    tum_.close();
  }
  void commit() { tum_.commit(); }
  const ReprocessReport::PerEstimator& report() const { return report_; }

 private:
  void write(const ins::NavigationSolution& base, const LocalFrame& frame) {
    const ros::Time time = timeOf(base.stamp);
    const auto odometry = odometryOf(base, frame, settings_);
    bag_.write(name_ + "/odometry", time, odometry);
    bag_.write(name_ + "/fix", time, fixOf(base, settings_));
    tum_.write(base.stamp, odometry.pose.pose);
    ++report_.estimates;
  }

  std::string name_;
  const InsSettings& settings_;
  OutputRate rate_;
  BagOutput& bag_;
  TumFile tum_;
  ReprocessReport::PerEstimator report_;
};

class InsRun final : public BagRun {
 public:
  InsRun(const InsSettings& settings, const std::string& file, InsTopics topics,
         const std::vector<std::string>& estimators, const RunOutput& out)
      : settings_(settings),
        file_(file),
        topics_(std::move(topics)),
        session_(settings.estimation.session, estimators, settings.make),
        ingest_(settings, out.transforms, [this](const ins::Reading& reading) { session_.process(reading); }) {
    for (const auto& name : estimators) writers_.push_back(std::make_unique<Writer>(name, settings, out));
  }

  bool isSensor(const BagConnection& connection) const override {
    const auto& all = {topics_.fix, topics_.imu, topics_.twist, topics_.depth, topics_.velocity};
    return std::find(all.begin(), all.end(), connection.topic) != all.end();
  }

  void take(const BagReader& bag, const BagMessage& message) override {
    const std::string& topic = message.connection->topic;
    if (topic == topics_.imu && bag.get(message, imu_)) ingest_.take(imu_);
    if (topic == topics_.fix && bag.get(message, fix_)) ingest_.take(fix_);
    if (topic == topics_.twist && bag.get(message, twist_)) ingest_.take(twist_);
    if (topic == topics_.depth && bag.get(message, depth_)) ingest_.take(depth_);
    if (topic == topics_.velocity && bag.get(message, twist_)) ingest_.takeVelocity(twist_);
    if (session_.unfed() < kBatch) return;
    session_.feed();
    drain();
  }

  void finish(ReprocessReport& report) override {
    ingest_.finish();
    session_.finish();
    drain();
    for (std::size_t i = 0; i < InsIngest::kSources; ++i)
      if (i != InsIngest::kVelocity || !topics_.velocity.empty())
        report.sensors[InsIngest::kNames[i]] = ingest_.inbox().counts(i);
    for (std::size_t i = 0; i < writers_.size(); ++i) {
      writers_[i]->finish(session_.lanes()[i]);
      report.estimators[session_.lanes()[i].name] = writers_[i]->report();
    }
    if (const std::string why = whyNotStarted(session_.alignment(), settings_); !why.empty() && nothingEstimated())
      throw std::runtime_error(fmt::format("{}: the INS never started: {}", file_, why));
    report.remarks = remarksOn(session_.inertial(), ingest_.inbox(), settings_);
  }

  void commit() override {
    for (auto& writer : writers_) writer->commit();
  }
  const std::optional<LocalFrame>& frame() const override { return ingest_.frame(); }

 private:
  bool nothingEstimated() const {
    return std::all_of(writers_.begin(), writers_.end(),
                       [](const auto& writer) { return writer->report().estimates == 0; });
  }
  void drain() {
    for (std::size_t i = 0; i < writers_.size(); ++i)
      writers_[i]->drain(session_.lanes()[i].output, frame(), ingest_.base_lever_body());
  }

  const InsSettings& settings_;
  std::string file_;
  InsTopics topics_;
  ins::Session session_;
  InsIngest ingest_;
  std::vector<std::unique_ptr<Writer>> writers_;
  sensor_msgs::NavSatFix fix_;
  sensor_msgs::Imu imu_;
  geometry_msgs::TwistWithCovarianceStamped twist_;
  geometry_msgs::PoseWithCovarianceStamped depth_;
};

class InsSystem final : public ReprocessSystem {
 public:
  explicit InsSystem(const std::string& config) : settings_(InsSettings::fromFile(config)) {}

  void require(const std::string& estimator) const override {
    const auto& known = settings_.estimators;
    if (std::find(known.begin(), known.end(), estimator) == known.end())
      throw std::runtime_error(
          fmt::format("'{}' is no estimator of this system; known are {}", estimator, fmt::join(known, ", ")));
  }
  std::unique_ptr<BagRun> begin(const BagReader& source, const std::string& file,
                                const std::vector<std::string>& estimators, const RunOutput& out) const override {
    return std::make_unique<InsRun>(settings_, file, findTopics(source.connections(), settings_, file), estimators,
                                    out);
  }
  const MapSettings& map() const override { return settings_; }

 private:
  InsSettings settings_;
};

}  // namespace

std::unique_ptr<ReprocessSystem> makeInsSystem(const std::string& config) {
  return std::make_unique<InsSystem>(config);
}

}  // namespace sas_motion::ros_side
