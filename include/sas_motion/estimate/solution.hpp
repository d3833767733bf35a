// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "sas_motion/math/stamp.hpp"
#include "sas_motion/math/types.hpp"
#include "sas_motion/navigation/local_frame.hpp"

namespace sas_motion {

/// The variance that stands for "not estimated" wherever a covariance has a place for it.
constexpr double kNotEstimated = 1e6;

/// How the water moves at the body.
struct Current {
  Vector<2> velocity_map = Vector<2>::Zero();  ///< east, north [m/s]
  Matrix<2> covariance = Matrix<2>::Zero();    ///< [m^2/s^2]
};

/// Position, attitude and velocity of the base at a stamp, the answer of an estimator of any system.
///
/// Axes are those of REP-103: the map's east, north, up; the base's forward, port, up. A covariance of zeros is not
/// known; kNotEstimated on its diagonal marks what the estimator does not estimate.
struct Solution {
  Stamp stamp = 0;
  Vector<3> position_map = Vector<3>::Zero();  ///< from the datum [m]
  Eigen::Quaterniond q_map_base = Eigen::Quaterniond::Identity();
  Vector<3> velocity_base = Vector<3>::Zero();     ///< over the ground [m/s]
  Vector<3> rate_base = Vector<3>::Zero();         ///< over the ground [rad/s]
  Matrix<6> pose_covariance = Matrix<6>::Zero();   ///< of position and rotation about the map's axes [m, rad]
  Matrix<6> twist_covariance = Matrix<6>::Zero();  ///< of velocity and rate [m/s, rad/s]
  std::optional<Geodetic> place;                   ///< of the position, where the map's datum is known
  std::optional<Matrix<3>> place_covariance;       ///< east, north, up [m^2]
  std::optional<Current> current;

  bool has_height() const { return pose_covariance(2, 2) < kNotEstimated; }
  bool has_heading() const { return pose_covariance(5, 5) < kNotEstimated; }
  bool has_attitude() const { return pose_covariance(3, 3) < kNotEstimated; }  ///< roll and pitch too
  bool has_velocity() const { return twist_covariance(0, 0) < kNotEstimated; }
  /// Whether the position has a covariance.
  bool has_covariance() const { return pose_covariance(0, 0) > 0; }
};

}  // namespace sas_motion
