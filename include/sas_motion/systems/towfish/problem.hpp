// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/systems/towfish/config.hpp"

namespace sas_motion::towfish {

/// The whole bag as one least-squares problem, the same for every smoother: a node for each stamp, and
///
///     1/2 |x_0 - m_0|^2_{P_0} + 1/2 sum |x_{k+1} - f(x_k)|^2_{Q_k} + sum rho((z - h(x_k)) / sigma)
///
/// with one rho for each scalar row. Q_k is frozen at the initial trajectory, so that all smoothers minimise the same
/// function.
struct SmoothingProblem {
  Model model;
  Gaussian<kStates> prior;                ///< of node 0, before its measurements
  std::vector<Stamp> stamps;              ///< of each node
  std::vector<Input> inputs;              ///< input on the way into each node; unused for node 0
  std::vector<StateMatrix> Q;             ///< process noise on the way into each node; unused for node 0
  std::vector<StateVector> initial;       ///< where iterations start
  std::vector<Measurement> measurements;  ///< with rows, in time order
  std::vector<std::size_t> first;  ///< node k has measurements first[k] to first[k + 1]; one more than there are nodes

  std::size_t nodes() const { return stamps.size(); }
  double dt(std::size_t node) const { return secondsBetween(stamps[node - 1], stamps[node]); }
};

/// The result of a smoother. `failure` has the reason in plain words where there is no solution, and is empty
/// otherwise.
struct SmootherResult {
  std::vector<Gaussian<kStates>> states;  ///< of each node
  std::vector<Vector<2>> weights;         ///< of each measurement's rows
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  std::string failure;
};

/// Builds the problem from measurements in time order, or nothing where they do not start (no position or no heading).
/// The initial trajectory is the robust Kalman filter's.
std::optional<SmoothingProblem> buildProblem(const std::vector<Measurement>& measurements, const Config& config);

/// The objective at a trajectory.
double cost(const SmoothingProblem& problem, const Loss& loss, const std::vector<StateVector>& states);

/// The loss's weight of each row of one measurement at a state.
Vector<2> weightsAt(const Measurement& z, const StateVector& x, const Model& model, const Loss& loss);

/// The loss's weight of every measurement row at a trajectory.
std::vector<Vector<2>> weightsAt(const SmoothingProblem& problem, const Loss& loss,
                                 const std::vector<StateVector>& states);

}  // namespace sas_motion::towfish
