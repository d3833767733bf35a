// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/conversions.hpp"

#include <charconv>
#include <cmath>

#include "ros/believed_variance.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::ros_side {
namespace {

Eigen::Quaterniond quaternionOf(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

geometry_msgs::Quaternion messageOf(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

double variance(double stated, double sigma) {
  return usableVariance(stated) || sigma > 0 ? believedVariance(stated, sigma, 0, false)
                                             : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

usbl::Reading readingOf(const sas_motion::UsblMeasurement& message, const UsblSettings& settings) {
  const double direction = variance(message.direction_variance, settings.direction_sigma);
  return {{message.slant_range, kPi - message.direction_y, message.direction_x},
          {variance(message.slant_range_variance, settings.range_sigma), direction, direction}};
}

sas_motion::UsblMeasurement measurementOf(const usbl::Reading& reading) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  sas_motion::UsblMeasurement message;
  message.slant_range = reading.value(0);
  message.slant_range_variance = reading.has(0) ? reading.variance(0) : -1;
  message.direction_x = reading.has(2) ? reading.value(2) : kAbsent;
  message.direction_y = reading.has(1) ? kPi - reading.value(1) : kAbsent;
  message.direction_variance = reading.has(1) ? reading.variance(1) : reading.has(2) ? reading.variance(2) : -1;
  return message;
}

std::optional<Matrix<3>> rotationOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu) {
  const Eigen::Quaterniond q = quaternionOf(imu.orientation);
  const bool unit = std::abs(q.squaredNorm() - 1) < 0.1;
  if (imu.orientation_covariance[0] == -1 || !unit) return std::nullopt;
  const Matrix<3> C_map_base = q.normalized().toRotationMatrix() * T_base_imu.linear().transpose();
  return C_map_base * bodyFromRosBody().transpose();
}

geometry_msgs::Quaternion orientationOf(const Matrix<3>& C_map_body) {
  return messageOf(Eigen::Quaterniond(C_map_body * bodyFromRosBody()));
}

usbl::Mounting mountingOf(const Transform& T) {
  const Matrix<3> B = bodyFromRosBody();
  return {B * T.linear() * B.transpose(), B * T.translation()};
}

Transform transformOf(const usbl::Mounting& mounting) {
  const Matrix<3> B = bodyFromRosBody();
  Transform T = Transform::Identity();
  T.linear() = B.transpose() * mounting.C_body_array * B;
  T.translation() = B.transpose() * mounting.lever_arm_body;
  return T;
}

std::optional<std::uint32_t> transponderId(const std::string& frame_id) {
  std::uint32_t id = 0;
  const char* end = frame_id.data() + frame_id.size();
  const auto [last, error] = std::from_chars(frame_id.data(), end, id);
  if (error != std::errc() || last != end) return std::nullopt;
  return id;
}

geometry_msgs::Transform messageOf(const Transform& transform) {
  geometry_msgs::Transform message;
  message.translation.x = transform.translation().x();
  message.translation.y = transform.translation().y();
  message.translation.z = transform.translation().z();
  message.rotation = messageOf(Eigen::Quaterniond(transform.linear()));
  return message;
}

}  // namespace sas_motion::ros_side
