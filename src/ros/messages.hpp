// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "sas_motion/math/stamp.hpp"
#include "sas_motion/math/types.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/local_frame.hpp"

/// What messages of every system are read and written by. Their axes are those of REP-103: east, north, up; forward,
/// port, up. The systems' own axes (starboard, forward, up; clockwise headings) begin behind these functions.
namespace sas_motion::ros_side {

/// A pose of a sensor in the base frame.
using Transform = Eigen::Isometry3d;

inline Stamp stampOf(const ros::Time& time) { return static_cast<Stamp>(time.toNSec()); }
ros::Time timeOf(Stamp stamp);

inline Vector<3> vectorOf(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }
inline Eigen::Quaterniond quaternionOf(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }
/// Sets the x, y and z of a vector or a point.
template <class Message>
void set(Message& message, const Vector<3>& v) {
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
}
geometry_msgs::Quaternion messageOf(const Eigen::Quaterniond& q);
Transform transformOf(const geometry_msgs::Transform& message);
geometry_msgs::Transform messageOf(const Transform& transform);
geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child, ros::Time time,
                                        const Transform& transform);

/// A vector of the base frame in starboard, forward, up.
inline Vector<3> bodyVectorOf(const Vector<3>& ros_body) { return bodyFromRosBody() * ros_body; }
/// v_map = C v_body of the base frame in starboard, forward, up, from the orientation of the sensor at T_base_imu;
/// nothing where the message has none.
std::optional<Matrix<3>> rotationOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu);
/// The orientation in REP-103's axes of such a rotation.
inline Eigen::Quaterniond orientationOf(const Matrix<3>& C_map_body) {
  return Eigen::Quaterniond(C_map_body * bodyFromRosBody());
}

/// True where a message has a fix, with coordinates on Earth.
bool hasPosition(const sensor_msgs::NavSatFix& fix);
Geodetic geodeticOf(const sensor_msgs::NavSatFix& fix);
/// A fix at a place, its covariance unknown.
sensor_msgs::NavSatFix fixAt(const Geodetic& place, ros::Time stamp, const std::string& frame_id);
/// The same with variances east, north and up [m^2].
sensor_msgs::NavSatFix fixAt(const Geodetic& place, ros::Time stamp, const std::string& frame_id,
                             const Vector<3>& variance);

bool usableVariance(double variance);
/// The variance that is taken of a message's: its own where usable, else the sensor's; not below the floor.
double usedVariance(double stated, double sigma, double floor, bool override_message);

}  // namespace sas_motion::ros_side
