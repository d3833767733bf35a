// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>

#include <string>

#include "systems/usbl/ros/conversions.hpp"

/// Messages that the recorders of several systems write.
namespace sas_motion {

inline geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child, ros::Time time,
                                               const ros_side::Transform& transform) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = time;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = ros_side::messageOf(transform);
  return message;
}

inline sensor_msgs::NavSatFix fixAt(const Geodetic& point, const std::string& frame, ros::Time time) {
  sensor_msgs::NavSatFix message;
  message.header.stamp = time;
  message.header.frame_id = frame;
  message.latitude = point.latitude_deg;
  message.longitude = point.longitude_deg;
  message.altitude = point.altitude;
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  return message;
}

}  // namespace sas_motion
