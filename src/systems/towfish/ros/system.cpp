// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/system.hpp"

#include <geometry_msgs/TwistWithCovarianceStamped.h>

#include <cmath>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/systems/towfish/session.hpp"
#include "systems/towfish/graph/estimators.hpp"

namespace sas_motion::ros_side {
namespace {

using namespace towfish;  // the names of the states
using Twist = geometry_msgs::TwistWithCovarianceStamped;
using Measurements = std::vector<Measurement>;

enum Source { kFix, kImu, kTwist, kVelocity };

double usedFrom(double variance, const SensorOptions& options) {
  return usedVariance(variance, options.sigma, options.floor, options.override_message);
}

Measurement begin(const ros::Time& stamp, Sensor sensor, const Config& config) {
  Measurement z;
  z.stamp = stampOf(stamp) + stampFromSeconds(config.sensor(sensor).time_offset);
  z.sensor = sensor;
  return z;
}

/// Clockwise from north, of a body whose x axis points forward.
double headingOf(const Eigen::Quaterniond& q_map_base) {
  const Eigen::Vector3d forward = q_map_base * Eigen::Vector3d::UnitX();
  return std::atan2(forward.x(), forward.y());
}

// Each message gives up to two measurements. What is absent in a message (no fix, no orientation, covariance[0] = -1)
// is left out; what is wrong in it comes through and is refused by the estimators, which count it.

std::vector<Measurement> measurementsOf(const sensor_msgs::NavSatFix& fix, const LocalFrame& frame,
                                        const Transform& T_base_gnss, const Config& config) {
  const SensorOptions& options = config.sensor(Sensor::Position);
  if (!options.enabled || fix.status.status < 0) return {};
  Measurement z = begin(fix.header.stamp, Sensor::Position, config);
  z.value.setConstant(NAN);
  if (hasPosition(fix)) {
    const Vector<3> enu = frame.position_enu(geodeticOf(fix));
    z.value << enu(1), enu(0);
  }
  const bool known = fix.position_covariance_type != sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  z.variance << usedFrom(known ? fix.position_covariance[4] : -1, options),
      usedFrom(known ? fix.position_covariance[0] : -1, options);
  z.lever_arm_body << T_base_gnss.translation().x(), -T_base_gnss.translation().y();
  return {z};
}

std::vector<Measurement> measurementsOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu,
                                        const Config& config) {
  std::vector<Measurement> measurements;
  const SensorOptions &heading = config.sensor(Sensor::Heading), &rate = config.sensor(Sensor::TurnRate);
  if (heading.enabled && imu.orientation_covariance[0] != -1) {
    Measurement z = begin(imu.header.stamp, Sensor::Heading, config);
    const Eigen::Quaterniond q = quaternionOf(imu.orientation);
    const bool unit = std::abs(q.squaredNorm() - 1) < 0.1;
    z.value(0) = unit ? headingOf(q.normalized() * Eigen::Quaterniond(T_base_imu.linear()).conjugate()) : NAN;
    z.value(1) = 0;
    z.variance.setConstant(usedFrom(imu.orientation_covariance[8], heading));
    measurements.push_back(z);
  }
  if (rate.enabled && imu.angular_velocity_covariance[0] != -1) {
    Measurement z = begin(imu.header.stamp, Sensor::TurnRate, config);
    const auto& w = imu.angular_velocity;
    z.value << -(T_base_imu.linear() * Eigen::Vector3d(w.x, w.y, w.z)).z(), 0;
    z.variance.setConstant(usedFrom(imu.angular_velocity_covariance[8], rate));
    measurements.push_back(z);
  }
  return measurements;
}

std::vector<Measurement> measurementsOf(const geometry_msgs::TwistWithCovarianceStamped& twist,
                                        const Transform& T_base_dvl, const Config& config) {
  const SensorOptions& options = config.sensor(Sensor::Speed);
  if (!options.enabled) return {};
  Measurement z = begin(twist.header.stamp, Sensor::Speed, config);
  const auto& v = twist.twist.twist.linear;
  const Eigen::Vector3d axis = T_base_dvl.linear().row(0);  // base x in the sensor's axes
  double speed = 0, variance = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis(i)) < 1e-6) continue;  // an axis that the sensor may not measure does not matter then
    speed += axis(i) * (i == 0 ? v.x : i == 1 ? v.y : v.z);
    variance += axis(i) * axis(i) * twist.twist.covariance[7 * static_cast<std::size_t>(i)];
  }
  z.value << speed, 0;
  z.variance.setConstant(usedFrom(variance, options));
  return {z};
}

/// Over ground, of a DVL with bottom lock. Its lever arm is not applied: a towed body turns slowly.
Measurements velocityOf(const Twist& twist, const Transform& T_base_dvl, const Config& config) {
  const SensorOptions& options = config.sensor(Sensor::Velocity);
  if (!options.enabled) return {};
  Measurement z = begin(twist.header.stamp, Sensor::Velocity, config);
  const Vector<3> velocity = T_base_dvl.linear() * vectorOf(twist.twist.twist.linear);
  const auto& P = twist.twist.covariance;
  const Vector<3> variance = T_base_dvl.linear().cwiseAbs2() * Vector<3>(P[0], P[7], P[14]);
  z.value << velocity.x(), -velocity.y();
  z.variance << usedFrom(variance.x(), options), usedFrom(variance.y(), options);
  return {z};
}

/// Messages become measurements of the towfish.
class TowfishRun final : public SystemRun {
 public:
  TowfishRun(const System& system, const Config& config, const std::vector<std::string>& names,
             const tf2::BufferCore& transforms, bool live)
      : SystemRun(system.map, system.sources, transforms),
        config_(config),
        session_(config, names, makeAnyEstimator, live) {
    listenAt<sensor_msgs::NavSatFix>(kFix, [this](const auto& fix, const Transform& T_base_gnss) {
      if (!frame_.map && hasPosition(fix)) setDatum(geodeticOf(fix));
      return frame_.map && pass(measurementsOf(fix, *frame_.map, T_base_gnss, config_));
    });
    listenAt<sensor_msgs::Imu>(kImu, [this](const auto& imu, const Transform& T_base_imu) {
      return pass(measurementsOf(imu, T_base_imu, config_));
    });
    listenAt<Twist>(kTwist, [this](const auto& twist, const Transform& T_base_dvl) {
      return pass(measurementsOf(twist, T_base_dvl, config_));
    });
    listenAt<Twist>(kVelocity, [this](const auto& twist, const Transform& T_base_dvl) {
      return pass(velocityOf(twist, T_base_dvl, config_));
    });
  }

  Session& session() override { return session_; }
  std::string waitsFor() const override {
    const auto readings = [this](Source source) {
      const MessageCounts& counts = inbox().counts(source);
      return counts.messages - counts.unusable - counts.unknown_frame - counts.disabled;
    };
    if (!config_.sensor(Sensor::Position).enabled) return sources()[kFix].topic + " is disabled";
    if (readings(kFix) == 0) return lackOf(kFix, "has no message with a fix");
    if (readings(kImu) == 0) return lackOf(kImu, "has no message with an orientation or a turn rate");
    return "";
  }

 private:
  /// Returns whether there was any.
  bool pass(const Measurements& measurements) {
    for (const auto& z : measurements) session_.process(z);
    return !measurements.empty();
  }

  Config config_;
  TowfishSession session_;
};

class TowfishSystem final : public System {
 public:
  explicit TowfishSystem(YamlSection& yaml) {
    sources = {sourceOf<sensor_msgs::NavSatFix>("fix", "gnss/fix", "positions are needed"),
               sourceOf<sensor_msgs::Imu>("imu", "imu/data", "headings are needed"),
               sourceOf<Twist>("twist", "dvl/twist", "speeds help"),
               sourceOf<Twist>("velocity", "dvl/velocity", "velocities over ground help")};
    sources[kVelocity].need = MessageSource::Need::NamedAlone;
    sources[kFix].need = sources[kImu].need = MessageSource::Need::Required;
    estimators = estimatorNames();
    preferred = {"kf", "robust_kf"};
    smoothers = {"fixed_lag"};
    has_current = true;
    readSystem(yaml, "towfish");
    readConfig(yaml, config_);
    readTopics(yaml, sources);
    map.readMap(yaml);
    yaml.finish();
    tuning = tuningOf(config_);
  }

  /// A filter with another loss has a name that is not listed.
  bool knows(const std::string& name) const override { return makeAnyEstimator(name, config_) != nullptr; }
  std::unique_ptr<SystemRun> begin(const std::vector<std::string>& names, const tf2::BufferCore& transforms,
                                   bool live) const override {
    return std::make_unique<TowfishRun>(*this, config_, names, transforms, live);
  }

 private:
  Config config_;
};

}  // namespace

std::unique_ptr<System> openTowfish(YamlSection& yaml) { return std::make_unique<TowfishSystem>(yaml); }

}  // namespace sas_motion::ros_side
