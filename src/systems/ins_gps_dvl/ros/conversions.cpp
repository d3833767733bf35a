// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ros/believed_variance.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "systems/usbl/ros/conversions.hpp"

namespace sas_motion::ros_side {
namespace {

using namespace ins;

constexpr double kNotEstimated = 1e6;      // variance of what a solution does not have
constexpr double kNoLock = 1e4;            // a DVL that states such a variance, or more, has no bottom lock [m^2/s^2]
constexpr double kUnknownAngle = kPi / 2;  // standard deviation of an angle that is not known at all [rad]
constexpr double kFastest = 30;            // beyond it a velocity is a driver's word for none [m/s]

Vector<3> vectorOf(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

Aiding begin(const ros::Time& stamp, Sensor sensor, const InsMount& mount, const ins::Settings& settings) {
  Aiding reading;
  reading.stamp = stampOf(stamp) + stampFromSeconds(settings.of(sensor).time_offset);
  reading.sensor = sensor;
  reading.lever_body = mount.lever_body();
  return reading;
}

Vector<3> believed(const Vector<3>& stated, const MessageOptions& options) {
  Vector<3> variance;
  for (int row = 0; row < 3; ++row)
    variance(row) = believedVariance(stated(row), options.white(row), options.floor, options.override_message);
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

/// A 6 x 6 covariance of a message from two 3-vectors' joint one.
template <class Message>
void fill(Message& covariance, const Matrix<6>& P) {
  for (int row = 0; row < 6; ++row)
    for (int col = 0; col < 6; ++col) covariance[static_cast<std::size_t>(6 * row + col)] = P(row, col);
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
  reading.variance = believed(stated, settings.of(Sensor::Gps));
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
  reading.variance = C_body_dvl.cwiseAbs2() * believed(stated, settings.of(Sensor::Dvl));
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
  reading.variance = believed(Vector<3>::Constant(depth.pose.covariance[14]), settings.of(Sensor::Depth));
  return reading;
}

Geodetic geodeticOf(const NavigationState& state) {
  return {state.latitude / kRadPerDeg, state.longitude / kRadPerDeg, state.height};
}

nav_msgs::Odometry odometryOf(const NavigationSolution& solution, const LocalFrame& frame, const InsSettings& settings) {
  const NavigationState& state = solution.state;
  const Geodetic point = geodeticOf(state);
  const Vector<3> position = frame.position_enu(point);
  const Matrix<3> C_map_nav = frame.C_map_nav(point), C_map_body = C_map_nav * state.q_nav_body.toRotationMatrix();
  const Matrix<3> C_base_body = bodyFromRosBody().transpose(),
                  C_base_nav = C_base_body * state.q_nav_body.conjugate().toRotationMatrix();
  nav_msgs::Odometry odometry;
  odometry.header.stamp = timeOf(solution.stamp);
  odometry.header.frame_id = settings.map_frame;
  odometry.child_frame_id = settings.base_frame;
  odometry.pose.pose.position.x = position.x();
  odometry.pose.pose.position.y = position.y();
  odometry.pose.pose.position.z = position.z();
  odometry.pose.pose.orientation = orientationOf(C_map_body);
  const auto set = [](geometry_msgs::Vector3& message, const Vector<3>& v) {
    message.x = v.x();
    message.y = v.y();
    message.z = v.z();
  };
  if (solution.has_velocity) set(odometry.twist.twist.linear, C_base_nav * state.velocity_nav);
  if (solution.rate_body) set(odometry.twist.twist.angular, C_base_body * *solution.rate_body);

  Matrix<6> pose = Matrix<6>::Zero(), twist = Matrix<6>::Zero();
  if (solution.covariance) {
    Matrix<6, 9> J = Matrix<6, 9>::Zero();  // of position and rotation in map
    J.block<3, 3>(0, kPosition) = C_map_nav;
    J.block<3, 3>(3, kAttitude) = -C_map_nav;
    pose = J * *solution.covariance * J.transpose();
    Matrix<3, 9> V = Matrix<3, 9>::Zero();  // of the velocity in the base: C'^T v' = C^T (v - v x phi)
    V.block<3, 3>(0, kVelocity) = C_base_nav;
    V.block<3, 3>(0, kAttitude) = -C_base_nav * skew(state.velocity_nav);
    twist.topLeftCorner<3, 3>() = V * *solution.covariance * V.transpose();
  }
  if (!solution.has_attitude) pose.diagonal().tail<3>().setConstant(kNotEstimated);
  if (!solution.has_velocity) twist.diagonal().head<3>().setConstant(kNotEstimated);
  if (!solution.rate_body) twist.diagonal().tail<3>().setConstant(kNotEstimated);
  fill(odometry.pose.covariance, pose);
  fill(odometry.twist.covariance, twist);
  return odometry;
}

sensor_msgs::NavSatFix fixOf(const NavigationSolution& solution, const InsSettings& settings) {
  sensor_msgs::NavSatFix fix = fixAt(geodeticOf(solution.state), timeOf(solution.stamp), settings.base_frame);
  if (!solution.covariance) return fix;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col)
      fix.position_covariance[static_cast<std::size_t>(3 * row + col)] =
          (*solution.covariance)(kPosition + row, kPosition + col);
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  return fix;
}

sas_motion::FilterUpdate updateOf(const ins::Audit& audit) {
  auto update = filterUpdateOf(audit, sensorName(audit.sensor), rowsOf(audit.sensor));
  update.effective_size = audit.effective_size;
  return update;
}

}  // namespace sas_motion::ros_side
