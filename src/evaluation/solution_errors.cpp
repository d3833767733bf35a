// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/solution_errors.hpp"

#include <cmath>

#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion {
namespace {

bool isFinite(const Solution& estimate) {
  return estimate.position_map.head<2>().allFinite() && estimate.q_map_base.coeffs().allFinite() &&
         std::isfinite(estimate.velocity_base.x()) && estimate.pose_covariance.allFinite() &&
         estimate.twist_covariance.allFinite() &&
         (!estimate.current ||
          (estimate.current->velocity_map.allFinite() && estimate.current->covariance.allFinite()));
}

/// Errors of one state; a variance of zero is not known.
void addOne(const char* name, double error, double variance, EstimatorScorer& scorer) {
  scorer.addError(name, std::abs(error));
  if (variance > 0) scorer.addNees(name, error * error / variance, 1);
}

/// Errors of two, east and north.
void addTwo(const char* name, const Vector<2>& error, const Matrix<2>& P, EstimatorScorer& scorer) {
  scorer.addError(name, std::hypot(error.y(), error.x()));
  if (!(P(1, 1) > 0)) return;
  Matrix<2> north_east;
  north_east << P(1, 1), P(0, 1), P(0, 1), P(0, 0);
  scorer.addNees(name, normalisedSquare<2>({error.y(), error.x()}, north_east), 2);
}

void addInSpace(const Solution& estimate, const Solution& truth, EstimatorScorer& scorer) {
  const auto& P = estimate.pose_covariance;
  const double height = estimate.position_map.z() - truth.position_map.z();
  scorer.addError("height", std::abs(height));
  if (estimate.has_covariance()) scorer.addNees("height", height * height / P(2, 2), 1);
  if (estimate.has_velocity()) {
    scorer.addError("velocity",
                    (estimate.q_map_base * estimate.velocity_base - truth.q_map_base * truth.velocity_base).norm());
    const Matrix<3> of_velocity = estimate.twist_covariance.topLeftCorner<3, 3>();
    if (of_velocity(0, 0) > 0)
      scorer.addNees("velocity", normalisedSquare<3>(estimate.velocity_base - truth.velocity_base, of_velocity), 3);
  }
  if (!estimate.has_attitude()) return;
  const Vector<2> tilt = attitudeError(estimate.q_map_base, truth.q_map_base).head<2>();
  scorer.addError("tilt", tilt.norm());
  if (P(3, 3) > 0) scorer.addNees("tilt", normalisedSquare<2>(tilt, P.block<2, 2>(3, 3)), 2);
}

}  // namespace

void score(const Solution& estimate, const TruePoint& truth, EstimatorScorer& scorer) {
  const Solution& exact = truth.solution;
  scorer.addSample(isFinite(estimate));
  if (!isFinite(estimate)) return;
  const Vector<2> position = (estimate.position_map - exact.position_map).head<2>();
  addTwo("position", position, estimate.pose_covariance.topLeftCorner<2, 2>(), scorer);
  if (const auto heading = headingError(estimate, truth))
    addOne("heading", *heading, estimate.pose_covariance(5, 5), scorer);
  const bool moves = estimate.has_velocity() && exact.has_velocity();
  if (moves)
    addOne("speed", estimate.velocity_base.x() - exact.velocity_base.x(), estimate.twist_covariance(0, 0), scorer);
  if (estimate.current && exact.current)
    addTwo("current", estimate.current->velocity_map - exact.current->velocity_map, estimate.current->covariance,
           scorer);
  if (estimate.has_height() && exact.has_height()) addInSpace(estimate, exact, scorer);
  const double heading = headingError(estimate, truth) ? truth.heading : headingOf(estimate.q_map_base);
  const double c = std::cos(heading), s = std::sin(heading);
  scorer.addOffset(secondsBetween(0, estimate.stamp), c * position.y() + s * position.x(),
                   c * position.x() - s * position.y(), (moves ? exact : estimate).velocity_base.x());
}

}  // namespace sas_motion
