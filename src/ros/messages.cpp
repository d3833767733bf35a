// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/messages.hpp"

#include <algorithm>
#include <cmath>

namespace sas_motion::ros_side {

ros::Time timeOf(Stamp stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

geometry_msgs::Quaternion messageOf(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

Transform transformOf(const geometry_msgs::Transform& message) {
  Transform T = Transform::Identity();
  T.linear() = quaternionOf(message.rotation).normalized().toRotationMatrix();
  T.translation() = vectorOf(message.translation);
  return T;
}

geometry_msgs::Transform messageOf(const Transform& transform) {
  geometry_msgs::Transform message;
  set(message.translation, transform.translation());
  message.rotation = messageOf(Eigen::Quaterniond(transform.linear()));
  return message;
}

geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child, ros::Time time,
                                        const Transform& transform) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = time;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = messageOf(transform);
  return message;
}

std::optional<Matrix<3>> rotationOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu) {
  const Eigen::Quaterniond q = quaternionOf(imu.orientation);
  const bool unit = std::abs(q.squaredNorm() - 1) < 0.1;
  if (imu.orientation_covariance[0] == -1 || !unit) return std::nullopt;
  const Matrix<3> C_map_base = q.normalized().toRotationMatrix() * T_base_imu.linear().transpose();
  return C_map_base * bodyFromRosBody().transpose();
}

bool hasPosition(const sensor_msgs::NavSatFix& fix) {
  return fix.status.status >= 0 && std::abs(fix.latitude) <= 90 && std::abs(fix.longitude) <= 360;
}

Geodetic geodeticOf(const sensor_msgs::NavSatFix& fix) {
  return {fix.latitude, fix.longitude, std::isfinite(fix.altitude) ? fix.altitude : 0};
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

sensor_msgs::NavSatFix fixAt(const Geodetic& place, ros::Time stamp, const std::string& frame_id,
                             const Vector<3>& variance) {
  sensor_msgs::NavSatFix fix = fixAt(place, stamp, frame_id);
  for (std::size_t i = 0; i < 3; ++i) fix.position_covariance[4 * i] = variance(static_cast<Eigen::Index>(i));
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  return fix;
}

bool usableVariance(double variance) { return std::isfinite(variance) && variance > 0; }

double usedVariance(double stated, double sigma, double floor, bool override_message) {
  return std::max(usableVariance(stated) && !override_message ? stated : sigma * sigma, floor * floor);
}

}  // namespace sas_motion::ros_side
