// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sas_motion/FilterUpdate.h>
#include <sas_motion/SetState.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include <Eigen/Geometry>

#include "ros/settings.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/systems/towfish/estimator.hpp"

/// The only place where the estimators' axes (north, east, clockwise heading) meet those of REP-103 (east, north,
/// counter-clockwise yaw; body x forward, y left, z up).
namespace sas_motion::ros_side {

using towfish::Audit;
using towfish::Estimate;
using towfish::Measurement;

/// A pose of a sensor in the base frame.
using Transform = Eigen::Isometry3d;

Transform transformOf(const geometry_msgs::Transform& message);

inline Stamp stampOf(const ros::Time& time) { return static_cast<Stamp>(time.toNSec()); }
ros::Time timeOf(Stamp stamp);

/// Each message gives up to two measurements. What is absent in a message (no fix, no orientation, covariance[0] = -1)
/// is left out; what is wrong in it comes through and is refused by the estimators, which count it.
std::vector<Measurement> measurementsOf(const sensor_msgs::NavSatFix& fix, const LocalFrame& frame,
                                        const Transform& T_base_gnss, const towfish::Config& config);
std::vector<Measurement> measurementsOf(const sensor_msgs::Imu& imu, const Transform& T_base_imu,
                                        const towfish::Config& config);
std::vector<Measurement> measurementsOf(const geometry_msgs::TwistWithCovarianceStamped& twist,
                                        const Transform& T_base_dvl, const towfish::Config& config);

/// True where a fix says where it is: has a fix, and coordinates on Earth.
bool hasPosition(const sensor_msgs::NavSatFix& fix);
Geodetic geodeticOf(const sensor_msgs::NavSatFix& fix);

/// The state that a request sets. Throws std::invalid_argument where it is none.
Gaussian<towfish::kStates> beliefOf(const sas_motion::SetStateRequest& request);

/// map -> base with covariance; the twist is over ground, in the base frame.
nav_msgs::Odometry odometryOf(const Estimate& estimate, const Settings& settings);
/// The current, east and north, in the map frame.
geometry_msgs::TwistWithCovarianceStamped currentOf(const Estimate& estimate, const Settings& settings);
sensor_msgs::NavSatFix fixOf(const Estimate& estimate, const LocalFrame& frame, const Settings& settings);
sas_motion::FilterUpdate updateOf(const Audit& audit);
/// A fix at a place, its covariance unknown.
sensor_msgs::NavSatFix fixAt(const Geodetic& place, ros::Time stamp, const std::string& frame_id);
sensor_msgs::NavSatFix datumOf(const LocalFrame& frame, const MapSettings& settings, ros::Time stamp);

/// The audit of `rows` rows of a sensor, of any system.
template <class AnyAudit>
sas_motion::FilterUpdate filterUpdateOf(const AnyAudit& audit, const char* sensor, int rows) {
  sas_motion::FilterUpdate update;
  update.header.stamp = timeOf(audit.stamp);
  update.sensor = sensor;
  update.innovation.assign(audit.innovation.data(), audit.innovation.data() + rows);
  update.weights.assign(audit.weights.data(), audit.weights.data() + rows);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < rows; ++col) update.innovation_covariance.push_back(audit.S(row, col));
  update.nis = audit.nis;
  update.verdict = static_cast<std::uint8_t>(audit.verdict);
  update.reason = audit.reason;
  update.iterations = static_cast<std::uint32_t>(audit.iterations);
  return update;
}

}  // namespace sas_motion::ros_side
