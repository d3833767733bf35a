// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>

#include <optional>

#include "ros/messages.hpp"
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

/// The only place where the axes of this system (starboard, forward, up; rotation errors C' = (I - [phi x]) C) meet
/// those of REP-103 (forward, port, up; rotations about fixed axes).
namespace sas_motion::ros_side {

/// Where the sensor of a message sits, and the IMU, whose place the INS is.
struct InsMount {
  Transform T_base_sensor = Transform::Identity();
  Transform T_base_imu = Transform::Identity();
  /// From the INS; body [m].
  Vector<3> lever_body() const;
};

// Each gives a reading, or nothing where the message has none: no fix, no bottom lock, not finite, no rates.
std::optional<ins::InertialReading> readingOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu,
                                              const ins::Settings& settings);
std::optional<ins::Aiding> readingOf(const sensor_msgs::NavSatFix& fix, const InsMount& mount,
                                     const ins::Settings& settings);
std::optional<ins::Aiding> readingOf(const geometry_msgs::TwistWithCovarianceStamped& twist, const InsMount& mount,
                                     const ins::Settings& settings);
/// Over the ground on the axes of REP-103's world: east, north, up.
std::optional<ins::GroundVelocity> groundVelocityOf(const geometry_msgs::TwistWithCovarianceStamped& twist,
                                                    const ins::Settings& settings);
/// Its z is the height above the water's surface, minus the depth.
std::optional<ins::Aiding> readingOf(const geometry_msgs::PoseWithCovarianceStamped& depth, const InsMount& mount,
                                     const ins::Settings& settings);

Geodetic geodeticOf(const NavigationState& state);

}  // namespace sas_motion::ros_side
