// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <optional>

#include "ros/conversions.hpp"
#include "sas_motion/systems/ins_gps_dvl/session.hpp"
#include "systems/ins_gps_dvl/ros/settings.hpp"

/// The only place where the axes of this system (starboard, forward, up; rotation errors C' = (I - [phi x]) C) meet
/// those of REP-103 (forward, port, up; rotations about fixed axes).
namespace sas_motion::ros_side {

/// Where the sensor of a message sits, and the inertial unit, whose place the INS is.
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

/// map -> base with covariance, of a solution of the base. The twist is in the base frame. A covariance of zeros is
/// unknown; 1e6 on a diagonal is what the solution does not have.
nav_msgs::Odometry odometryOf(const ins::NavigationSolution& solution, const LocalFrame& frame, const InsSettings& settings);
sensor_msgs::NavSatFix fixOf(const ins::NavigationSolution& solution, const InsSettings& settings);
sas_motion::FilterUpdate updateOf(const ins::Audit& audit);

}  // namespace sas_motion::ros_side
