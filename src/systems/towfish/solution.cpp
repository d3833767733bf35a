// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/solution.hpp"

#include <cmath>

namespace sas_motion::towfish {
namespace {

/// Velocity over ground, forward and left, and its derivative by the state.
struct GroundVelocity {
  explicit GroundVelocity(const StateVector& x) {
    const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
    const double along = c * x(kCurrentNorth) + s * x(kCurrentEast), left = s * x(kCurrentNorth) - c * x(kCurrentEast);
    value << x(kSpeed) + along, left;
    J.setZero();
    J(0, kCurrentNorth) = c;
    J(0, kCurrentEast) = s;
    J(0, kHeading) = -left;
    J(0, kSpeed) = 1;
    J(1, kCurrentNorth) = s;
    J(1, kCurrentEast) = -c;
    J(1, kHeading) = along;
  }
  Vector<2> value;
  Matrix<2, kStates> J;
};

/// The covariance of north and east in the order of a map: east, north.
Matrix<2> eastNorth(const StateMatrix& P, int north, int east) {
  return (Matrix<2>() << P(east, east), P(east, north), P(east, north), P(north, north)).finished();
}

}  // namespace

Solution solutionOf(const Estimate& estimate, const LocalFrame* map) {
  const StateVector& x = estimate.belief.mean;
  const StateMatrix& P = estimate.belief.covariance;
  const double yaw = kPi / 2 - x(kHeading);
  Solution solution;
  solution.stamp = estimate.stamp;
  solution.position_map << x(kEast), x(kNorth), 0;
  solution.q_map_base = Eigen::Quaterniond(std::cos(yaw / 2), 0, 0, std::sin(yaw / 2));
  auto& pose = solution.pose_covariance;
  pose.topLeftCorner<2, 2>() = eastNorth(P, kNorth, kEast);
  pose(0, 5) = pose(5, 0) = -P(kEast, kHeading);  // yaw runs against heading
  pose(1, 5) = pose(5, 1) = -P(kNorth, kHeading);
  pose(5, 5) = P(kHeading, kHeading);
  pose(2, 2) = pose(3, 3) = pose(4, 4) = kNotEstimated;

  const GroundVelocity velocity(x);
  solution.velocity_base.head<2>() = velocity.value;
  const Matrix<2> V = velocity.J * P * velocity.J.transpose();
  solution.twist_covariance.topLeftCorner<2, 2>() << V(0, 0), V(0, 1), V(0, 1), V(1, 1);
  solution.twist_covariance.diagonal().tail<4>().setConstant(kNotEstimated);
  solution.current = Current{{x(kCurrentEast), x(kCurrentNorth)}, eastNorth(P, kCurrentNorth, kCurrentEast)};
  if (!map) return solution;
  solution.place = map->geodetic(solution.position_map);
  solution.place_covariance = Matrix<3>::Zero();
  solution.place_covariance->topLeftCorner<2, 2>() = pose.topLeftCorner<2, 2>();
  (*solution.place_covariance)(2, 2) = kNotEstimated;
  return solution;
}

Gaussian<kStates> beliefOf(const StateRequest& request) {
  const Vector<6>& x = request.state;
  const Matrix<6>& P = request.covariance;
  StateMatrix axes = StateMatrix::Zero();  // from x, y, counter-clockwise to north, east, clockwise
  axes(kNorth, 1) = axes(kEast, 0) = axes(kCurrentNorth, 3) = axes(kCurrentEast, 2) = axes(kSpeed, 5) = 1;
  axes(kHeading, 4) = -1;
  Gaussian<kStates> belief{axes * x, axes * (0.5 * (P + P.transpose())) * axes.transpose()};
  belief.mean(kHeading) = wrapAngle(kPi / 2 - x(4));
  return belief;
}

}  // namespace sas_motion::towfish
