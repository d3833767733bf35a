// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "sas_motion/evaluation/scores.hpp"

namespace sas_motion {

/// How a body is and moves at a stamp, in six degrees of freedom, with covariances where they are known.
struct MotionSample {
  Stamp stamp = 0;
  Vector<3> position_map = Vector<3>::Zero();  ///< east, north, up [m]
  Eigen::Quaterniond q_map_base = Eigen::Quaterniond::Identity();
  Vector<3> velocity_base = Vector<3>::Zero();                               ///< over the ground [m/s]
  bool lying = true, moving = true;                                          ///< attitude and velocity are known
  std::optional<Matrix<3>> P_position_map, P_rotation_map, P_velocity_base;  ///< [m^2], [rad^2], [m^2/s^2]
};

/// Truth between two samples: the straight line and the shortest rotation.
MotionSample interpolate(const MotionSample& before, const MotionSample& after, Stamp stamp);

/// What is scored of six degrees of freedom beside the horizontal position, heading and speed.
enum MotionGroup { kHeightGroup, kVelocityGroup, kTiltGroup, kMotionGroups };
constexpr std::array<const char*, kMotionGroups> kMotionGroupNames{"height", "velocity", "tilt"};

struct MotionScores {
  std::array<std::optional<towfish::ErrorSummary>, kMotionGroups> error;  ///< [m, m/s, rad]
  std::array<std::optional<towfish::Consistency>, kMotionGroups> nees;
};

/// Collects one estimator's errors over a run, sample by sample, and sums them up.
class MotionScorer {
 public:
  void add(const MotionSample& estimate, const MotionSample& truth);
  MotionScores scores() const;

 private:
  std::array<std::vector<double>, kMotionGroups> errors_, nees_;
};

}  // namespace sas_motion
