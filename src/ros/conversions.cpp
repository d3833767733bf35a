// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

#include "ros/believed_variance.hpp"

namespace sas_motion::ros_side {
namespace {

using towfish::Sensor;
using namespace towfish;  // the names of the states

double believed(double variance, const SensorOptions& options) {
  return believedVariance(variance, options.sigma, options.floor, options.override_message);
}

Measurement begin(const ros::Time& stamp, Sensor sensor, const Config& config) {
  Measurement z;
  z.stamp = stampOf(stamp) + stampFromSeconds(config.sensor(sensor).time_offset);
  z.sensor = sensor;
  return z;
}

Eigen::Quaterniond quaternionOf(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

/// Clockwise from north, of a body whose x axis points forward.
double headingOf(const Eigen::Quaterniond& q_map_base) {
  const Eigen::Vector3d forward = q_map_base * Eigen::Vector3d::UnitX();
  return std::atan2(forward.x(), forward.y());
}

geometry_msgs::Quaternion orientationOf(double heading) {
  const double yaw = kPi / 2 - heading;
  geometry_msgs::Quaternion q;
  q.z = std::sin(yaw / 2);
  q.w = std::cos(yaw / 2);
  return q;
}

/// Velocity over ground, forward and left, and its derivative by the state.
struct GroundVelocity {
  explicit GroundVelocity(const StateVector& x) {
    const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
    const double along = c * x(kCurrentNorth) + s * x(kCurrentEast), left = s * x(kCurrentNorth) - c * x(kCurrentEast);
    value << x(kSpeed) + along, left;
    J.setZero();
    J(0, kCurrentNorth) = c;
    J(0, kCurrentEast) = s;
    J(0, kHeading) = -left;
    J(0, kSpeed) = 1;
    J(1, kCurrentNorth) = s;
    J(1, kCurrentEast) = -c;
    J(1, kHeading) = along;
  }
  Vector<2> value;
  Matrix<2, kStates> J;
};

constexpr double kUnknown = 1e6;  // variance of what the model does not estimate

}  // namespace

ros::Time timeOf(Stamp stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

Transform transformOf(const geometry_msgs::Transform& message) {
  Transform T = Transform::Identity();
  T.linear() = quaternionOf(message.rotation).normalized().toRotationMatrix();
  T.translation() << message.translation.x, message.translation.y, message.translation.z;
  return T;
}

bool hasPosition(const sensor_msgs::NavSatFix& fix) {
  return fix.status.status >= 0 && std::abs(fix.latitude) <= 90 && std::abs(fix.longitude) <= 360;
}

Geodetic geodeticOf(const sensor_msgs::NavSatFix& fix) {
  return {fix.latitude, fix.longitude, std::isfinite(fix.altitude) ? fix.altitude : 0};
}

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
  z.variance << believed(known ? fix.position_covariance[4] : -1, options),
      believed(known ? fix.position_covariance[0] : -1, options);
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
    z.variance.setConstant(believed(imu.orientation_covariance[8], heading));
    measurements.push_back(z);
  }
  if (rate.enabled && imu.angular_velocity_covariance[0] != -1) {
    Measurement z = begin(imu.header.stamp, Sensor::TurnRate, config);
    const auto& w = imu.angular_velocity;
    z.value << -(T_base_imu.linear() * Eigen::Vector3d(w.x, w.y, w.z)).z(), 0;
    z.variance.setConstant(believed(imu.angular_velocity_covariance[8], rate));
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
  z.variance.setConstant(believed(variance, options));
  return {z};
}

Gaussian<kStates> beliefOf(const sas_motion::SetStateRequest& request) {
  StateMatrix P = StateMatrix::Zero();
  constexpr std::size_t n = kStates;
  if (request.covariance.size() == n * n) {
    P = Eigen::Map<const Eigen::Matrix<double, kStates, kStates, Eigen::RowMajor>>(request.covariance.data());
  } else if (request.covariance.size() == n) {
    P = Eigen::Map<const StateVector>(request.covariance.data()).cwiseAbs2().asDiagonal();
  } else {
    throw std::invalid_argument("covariance has " + std::to_string(request.covariance.size()) +
                                " numbers; give 36, row-major, or 6 standard deviations");
  }
  const Eigen::Map<const StateVector> x(request.state.data());
  if (!x.allFinite() || x.cwiseAbs().maxCoeff() > 1e9) throw std::invalid_argument("state is not finite");
  const double asymmetry = (P - P.transpose()).cwiseAbs().maxCoeff();
  if (!P.allFinite() || asymmetry > 1e-9 * P.cwiseAbs().maxCoeff() ||
      Eigen::LLT<StateMatrix>(P).info() != Eigen::Success)
    throw std::invalid_argument("covariance is not symmetric and positive definite");
  StateMatrix axes = StateMatrix::Zero();  // from x, y, counter-clockwise to north, east, clockwise
  axes(kNorth, 1) = axes(kEast, 0) = axes(kCurrentNorth, 3) = axes(kCurrentEast, 2) = axes(kSpeed, 5) = 1;
  axes(kHeading, 4) = -1;
  Gaussian<kStates> belief{axes * x, axes * (0.5 * (P + P.transpose())) * axes.transpose()};
  belief.mean(kHeading) = wrapAngle(kPi / 2 - x(4));
  return belief;
}

nav_msgs::Odometry odometryOf(const Estimate& estimate, const Settings& settings) {
  const StateVector& x = estimate.belief.mean;
  const StateMatrix& P = estimate.belief.covariance;
  nav_msgs::Odometry odometry;
  odometry.header.stamp = timeOf(estimate.stamp);
  odometry.header.frame_id = settings.map_frame;
  odometry.child_frame_id = settings.base_frame;
  odometry.pose.pose.position.x = x(kEast);
  odometry.pose.pose.position.y = x(kNorth);
  odometry.pose.pose.orientation = orientationOf(x(kHeading));
  auto& pose = odometry.pose.covariance;
  pose[0] = P(kEast, kEast);
  pose[1] = pose[6] = P(kEast, kNorth);
  pose[7] = P(kNorth, kNorth);
  pose[5] = pose[30] = -P(kEast, kHeading);  // yaw runs against heading
  pose[11] = pose[31] = -P(kNorth, kHeading);
  pose[35] = P(kHeading, kHeading);
  pose[14] = pose[21] = pose[28] = kUnknown;
  const GroundVelocity velocity(x);
  const Matrix<2> V = velocity.J * P * velocity.J.transpose();
  odometry.twist.twist.linear.x = velocity.value(0);
  odometry.twist.twist.linear.y = velocity.value(1);
  auto& twist = odometry.twist.covariance;
  twist[0] = V(0, 0);
  twist[1] = twist[6] = V(0, 1);
  twist[7] = V(1, 1);
  twist[14] = twist[21] = twist[28] = twist[35] = kUnknown;
  return odometry;
}

geometry_msgs::TwistWithCovarianceStamped currentOf(const Estimate& estimate, const Settings& settings) {
  const StateVector& x = estimate.belief.mean;
  const StateMatrix& P = estimate.belief.covariance;
  geometry_msgs::TwistWithCovarianceStamped current;
  current.header.stamp = timeOf(estimate.stamp);
  current.header.frame_id = settings.map_frame;
  current.twist.twist.linear.x = x(kCurrentEast);
  current.twist.twist.linear.y = x(kCurrentNorth);
  auto& covariance = current.twist.covariance;
  covariance[0] = P(kCurrentEast, kCurrentEast);
  covariance[1] = covariance[6] = P(kCurrentEast, kCurrentNorth);
  covariance[7] = P(kCurrentNorth, kCurrentNorth);
  covariance[14] = covariance[21] = covariance[28] = covariance[35] = kUnknown;
  return current;
}

sensor_msgs::NavSatFix fixOf(const Estimate& estimate, const LocalFrame& frame, const Settings& settings) {
  const StateVector& x = estimate.belief.mean;
  const StateMatrix& P = estimate.belief.covariance;
  sensor_msgs::NavSatFix fix =
      fixAt(frame.geodetic({x(kEast), x(kNorth), 0}), timeOf(estimate.stamp), settings.base_frame);
  fix.position_covariance = {P(kEast, kEast), P(kEast, kNorth), 0, P(kEast, kNorth), P(kNorth, kNorth), 0, 0, 0,
                             kUnknown};
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  return fix;
}

sas_motion::FilterUpdate updateOf(const Audit& audit) {
  auto update = filterUpdateOf(audit, towfish::sensorName(audit.sensor), audit.rows);
  if (audit.hypotheses[0] > 0) update.hypotheses.assign(audit.hypotheses.begin(), audit.hypotheses.end());
  return update;
}

sensor_msgs::NavSatFix fixAt(const Geodetic& place, ros::Time stamp, const std::string& frame_id) {
  sensor_msgs::NavSatFix fix;
  fix.header.stamp = stamp;
  fix.header.frame_id = frame_id;
  fix.latitude = place.latitude_deg;
  fix.longitude = place.longitude_deg;
  fix.altitude = place.altitude;
  return fix;
}

sensor_msgs::NavSatFix datumOf(const LocalFrame& frame, const MapSettings& settings, ros::Time stamp) {
  return fixAt(frame.datum(), stamp, settings.map_frame);
}

}  // namespace sas_motion::ros_side
