// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/motion_scores.hpp"

#include <Eigen/Cholesky>

#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion {
namespace {

constexpr std::array<double, kMotionGroups> kDegrees{1, 3, 2};

template <class Error, class Covariance>
double normalisedSquare(const Error& error, const Covariance& P) {
  return error.dot(P.llt().solve(error));
}

}  // namespace

MotionSample interpolate(const MotionSample& before, const MotionSample& after, Stamp stamp) {
  const double share = secondsBetween(before.stamp, stamp) / secondsBetween(before.stamp, after.stamp);
  MotionSample sample = before;
  sample.stamp = stamp;
  sample.position_map += share * (after.position_map - before.position_map);
  sample.velocity_base += share * (after.velocity_base - before.velocity_base);
  sample.q_map_base = before.q_map_base.slerp(share, after.q_map_base);
  return sample;
}

void MotionScorer::add(const MotionSample& estimate, const MotionSample& truth) {
  const Vector<3> position = estimate.position_map - truth.position_map;
  errors_[kHeightGroup].push_back(std::abs(position.z()));
  if (estimate.P_position_map)
    nees_[kHeightGroup].push_back(position.z() * position.z() / (*estimate.P_position_map)(2, 2));
  if (estimate.moving) {
    errors_[kVelocityGroup].push_back(
        (estimate.q_map_base * estimate.velocity_base - truth.q_map_base * truth.velocity_base).norm());
    const Vector<3> velocity = estimate.velocity_base - truth.velocity_base;
    if (estimate.P_velocity_base)
      nees_[kVelocityGroup].push_back(normalisedSquare(velocity, *estimate.P_velocity_base));
  }
  if (!estimate.lying) return;
  const Vector<2> tilt = attitudeError(estimate.q_map_base, truth.q_map_base).head<2>();
  errors_[kTiltGroup].push_back(tilt.norm());
  if (estimate.P_rotation_map)
    nees_[kTiltGroup].push_back(normalisedSquare(tilt, Matrix<2>(estimate.P_rotation_map->topLeftCorner<2, 2>())));
}

MotionScores MotionScorer::scores() const {
  MotionScores scores;
  for (std::size_t i = 0; i < kMotionGroups; ++i) {
    if (!errors_[i].empty()) scores.error[i] = towfish::summarize(errors_[i]);
    if (!nees_[i].empty()) scores.nees[i] = towfish::consistency(nees_[i], kDegrees[i]);
  }
  return scores;
}

}  // namespace sas_motion
