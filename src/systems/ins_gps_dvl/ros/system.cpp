// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/system.hpp"

#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"
#include "systems/ins_gps_dvl/graph/smoother.hpp"
#include "systems/ins_gps_dvl/ros/run.hpp"

namespace sas_motion::ros_side {
namespace {

using Twist = geometry_msgs::TwistWithCovarianceStamped;
using Source = NavigationRun::Source;

class InsGpsDvlSystem final : public NavigationSystem {
 public:
  explicit InsGpsDvlSystem(YamlSection& yaml) : NavigationSystem(ins::makeAnyEstimator, "") {
    estimators = ins::anyEstimatorNames();
    preferred = {"robust_kf27"};
    ins::readSettings(yaml, estimation_);
    readRest(yaml);
  }
  std::string currentName(const std::string& estimator) const override { return ins::currentName(estimator); }
};

}  // namespace

NavigationSystem::NavigationSystem(ins::EstimatorFactory make, const std::string& velocity_topic)
    : make_(std::move(make)) {
  using Need = MessageSource::Need;
  sources = {sourceOf<sensor_msgs::NavSatFix>("fix", "gnss/fix", "positions are needed"),
             sourceOf<sensor_msgs::Imu>("imu", "imu/data", "rates and specific forces are needed"),
             sourceOf<Twist>("twist", "dvl/twist", "velocities are needed"),
             sourceOf<geometry_msgs::PoseWithCovarianceStamped>("depth", "depth/pose", "depths are needed"),
             sourceOf<Twist>("velocity", velocity_topic, "the start is better known by it")};
  for (auto& source : sources) source.need = Need::Required;
  sources[Source::kVelocity].need = Need::NamedAlone;
  sources[Source::kVelocity].may_fall_silent = true;
  smoothers = {"fixed_lag"};
}

void NavigationSystem::readRest(YamlSection& yaml) {
  readTopics(yaml, sources);
  map.readMap(yaml);
  yaml.finish();
  sources[Source::kFix].enabled = estimation_.of(ins::Sensor::Gps).enabled;
  sources[Source::kTwist].enabled = estimation_.of(ins::Sensor::Dvl).enabled;
  sources[Source::kDepth].enabled = estimation_.of(ins::Sensor::Depth).enabled;
  sources[Source::kFix].may_fall_silent = !estimation_.session.alignment.fixes_aid;
  output_rate = estimation_.output_rate;
  tuning = tuningOf(estimation_.session.config);
}

std::unique_ptr<SystemRun> NavigationSystem::begin(const std::vector<std::string>& names,
                                                   const tf2::BufferCore& transforms, bool live) const {
  return std::make_unique<NavigationRun>(*this, make_, names, transforms, live);
}

std::unique_ptr<System> openInsGpsDvl(YamlSection& yaml) { return std::make_unique<InsGpsDvlSystem>(yaml); }

}  // namespace sas_motion::ros_side
