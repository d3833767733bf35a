// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"

namespace sas_motion::ros_side {
namespace {

using namespace ins;

constexpr double kNoLock = 1e4;            // a DVL that states such a variance, or more, has no bottom lock [m^2/s^2]
constexpr double kUnknownAngle = kPi / 2;  // standard deviation of an angle that is not known at all [rad]
constexpr double kFastest = 30;            // beyond it a velocity is a driver's word for none [m/s]

Aiding begin(const ros::Time& stamp, Sensor sensor, const InsMount& mount, const ins::Settings& settings) {
  Aiding reading;
  reading.stamp = stampOf(stamp) + stampFromSeconds(settings.of(sensor).time_offset);
  reading.sensor = sensor;
  reading.lever_body = mount.lever_body();
  return reading;
}

Vector<3> usedFrom(const Vector<3>& stated, const MessageOptions& options) {
  Vector<3> variance;
  for (int row = 0; row < 3; ++row)
    variance(row) = usedVariance(stated(row), options.white(row), options.floor, options.override_message);
  return variance;
}

std::optional<MeasuredAttitude> attitudeOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu,
                                           const Parameters& parameters) {
  const auto C_nav_body = rotationOf(imu, T_base_imu);
  if (!C_nav_body) return std::nullopt;
  const auto& P = imu.orientation_covariance;
  const auto sigma = [](double variance, double otherwise) {
    return usableVariance(variance) ? std::min(std::sqrt(variance), kUnknownAngle) : otherwise;
  };
  const double tilt = std::max(sigma(P[0], parameters.start_tilt), sigma(P[4], parameters.start_tilt));
  return MeasuredAttitude{Eigen::Quaterniond(*C_nav_body), tilt, sigma(P[8], parameters.start_heading)};
}

}  // namespace

Vector<3> InsMount::lever_body() const { return bodyVectorOf(T_base_sensor.translation() - T_base_imu.translation()); }

std::optional<InertialReading> readingOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu,
                                         const ins::Settings& settings) {
  if (imu.angular_velocity_covariance[0] == -1 || imu.linear_acceleration_covariance[0] == -1) return std::nullopt;
  InertialReading reading;
  reading.imu.stamp = stampOf(imu.header.stamp) + stampFromSeconds(settings.imu_time_offset);
  reading.imu.rate_body = bodyVectorOf(T_base_imu.linear() * vectorOf(imu.angular_velocity));
  reading.imu.force_body = bodyVectorOf(T_base_imu.linear() * vectorOf(imu.linear_acceleration));
  if (!reading.imu.rate_body.allFinite() || !reading.imu.force_body.allFinite()) return std::nullopt;
  reading.attitude = attitudeOf(imu, T_base_imu, settings.session.config.parameters);
  return reading;
}

std::optional<Aiding> readingOf(const sensor_msgs::NavSatFix& fix, const InsMount& mount,
                                const ins::Settings& settings) {
  if (!hasPosition(fix) || !std::isfinite(fix.altitude)) return std::nullopt;
  Aiding reading = begin(fix.header.stamp, Sensor::Gps, mount, settings);
  reading.fix.latitude = fix.latitude * kRadPerDeg;
  reading.fix.longitude = fix.longitude * kRadPerDeg;
  reading.fix.height = fix.altitude;
  const bool known = fix.position_covariance_type != sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  const auto& P = fix.position_covariance;
  const Vector<3> stated = known ? Vector<3>(P[0], P[4], P[8]) : Vector<3>(-1, -1, -1);
  reading.variance = usedFrom(stated, settings.of(Sensor::Gps));
  return reading;
}

std::optional<Aiding> readingOf(const geometry_msgs::TwistWithCovarianceStamped& twist, const InsMount& mount,
                                const ins::Settings& settings) {
  const Vector<3> velocity = vectorOf(twist.twist.twist.linear);
  const auto& P = twist.twist.covariance;
  const Vector<3> stated(P[0], P[7], P[14]);
  if (!(velocity.norm() <= kFastest) || (stated.array() < 0).any() || (stated.array() >= kNoLock).any())
    return std::nullopt;
  Aiding reading = begin(twist.header.stamp, Sensor::Dvl, mount, settings);
  const Matrix<3> C_body_dvl = bodyFromRosBody() * mount.T_base_sensor.linear();
  reading.velocity_body = C_body_dvl * velocity;
  reading.variance = C_body_dvl.cwiseAbs2() * usedFrom(stated, settings.of(Sensor::Dvl));
  return reading;
}

std::optional<GroundVelocity> groundVelocityOf(const geometry_msgs::TwistWithCovarianceStamped& twist,
                                               const ins::Settings& settings) {
  const Vector<3> velocity = vectorOf(twist.twist.twist.linear);
  const auto& P = twist.twist.covariance;
  const std::array<double, 3> stated{P[0], P[7], P[14]};
  const bool refused =
      std::any_of(stated.begin(), stated.end(), [](double variance) { return variance < 0 || variance >= kNoLock; });
  if (!(velocity.norm() <= kFastest) || refused) return std::nullopt;
  double sigma = 0;
  for (const double variance : stated)
    sigma = std::max(sigma,
                     usableVariance(variance) ? std::sqrt(variance) : settings.session.alignment.ground_velocity_sigma);
  return GroundVelocity{stampOf(twist.header.stamp) + stampFromSeconds(settings.of(Sensor::Gps).time_offset), velocity,
                        sigma};
}

std::optional<Aiding> readingOf(const geometry_msgs::PoseWithCovarianceStamped& depth, const InsMount& mount,
                                const ins::Settings& settings) {
  const double z = depth.pose.pose.position.z;
  if (!std::isfinite(z)) return std::nullopt;
  Aiding reading = begin(depth.header.stamp, Sensor::Depth, mount, settings);
  reading.fix.height = settings.surface + z;
  reading.variance = usedFrom(Vector<3>::Constant(depth.pose.covariance[14]), settings.of(Sensor::Depth));
  return reading;
}

Geodetic geodeticOf(const NavigationState& state) {
  return {state.latitude / kRadPerDeg, state.longitude / kRadPerDeg, state.height};
}

}  // namespace sas_motion::ros_side
