// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sas_motion/FilterUpdate.h>

#include "ros/messages.hpp"
#include "ros/settings.hpp"
#include "sas_motion/estimate/output.hpp"

/// The one place where an answer becomes messages, and messages an answer again.
namespace sas_motion::ros_side {

/// map -> base with covariance; the twist is over ground, in the base frame.
nav_msgs::Odometry odometryOf(const Solution& solution, const MapSettings& settings);
/// The current of a solution that has one, in the map frame.
geometry_msgs::TwistWithCovarianceStamped currentOf(const Solution& solution, const MapSettings& settings);
/// The place of a solution that has one.
sensor_msgs::NavSatFix fixOf(const Solution& solution, const MapSettings& settings);
sas_motion::FilterUpdate updateOf(const Audit& audit);

/// All that an odometry message has of a solution.
Solution solutionOf(const nav_msgs::Odometry& odometry);
Current currentOf(const geometry_msgs::TwistWithCovarianceStamped& message);
/// `sensor` is the name of the update's sensor, and outlives the audit. Rows beyond kMostRows are left out.
Audit auditOf(const sas_motion::FilterUpdate& update, std::string_view sensor);

/// Hands everything in an output to `write(topic, stamp, message)`: NAME/odometry, NAME/fix, NAME/current for each
/// solution, NAME/update for each audit, merged in time order.
template <class Write>
void forEachMessage(const std::string& name, const Output& output, const MapSettings& settings, const Write& write) {
  inTimeOrder(
      output,
      [&](const Solution& solution) {
        const ros::Time time = timeOf(solution.stamp);
        write(name + "/odometry", time, odometryOf(solution, settings));
        if (solution.place) write(name + "/fix", time, fixOf(solution, settings));
        if (solution.current) write(name + "/current", time, currentOf(solution, settings));
      },
      [&](const Audit& audit) { write(name + "/update", timeOf(audit.stamp), updateOf(audit)); });
}

}  // namespace sas_motion::ros_side
