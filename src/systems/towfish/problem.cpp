// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/problem.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/factorization.hpp"
#include "sas_motion/systems/towfish/held_input.hpp"
#include "sas_motion/systems/towfish/start.hpp"

namespace sas_motion::towfish {
namespace {

/// Half the squared Mahalanobis length of a residual.
double halfSquared(const Matrix<kStates>& covariance, const StateVector& residual) {
  return 0.5 * residual.dot(covariance.llt().solve(residual));
}

/// Where the measurements start to tell position and heading, and the belief there.
struct Start {
  std::size_t first;
  Gaussian<kStates> prior;
};

std::optional<Start> findStart(const std::vector<Measurement>& measurements, const Config& config) {
  const auto has = [&](std::size_t from, std::size_t to, Sensor sensor) {
    return std::any_of(measurements.begin() + static_cast<std::ptrdiff_t>(from),
                       measurements.begin() + static_cast<std::ptrdiff_t>(to),
                       [&](const Measurement& z) { return z.sensor == sensor; });
  };
  for (std::size_t first = 0, end = 0; first < measurements.size(); ++first) {
    const Stamp last = measurements[first].stamp + stampFromSeconds(config.start.window);
    while (end < measurements.size() && measurements[end].stamp <= last) ++end;
    if (!has(first, end, Sensor::Position) || !has(first, end, Sensor::Heading)) continue;
    const std::vector<Measurement> window(measurements.begin() + static_cast<std::ptrdiff_t>(first),
                                          measurements.begin() + static_cast<std::ptrdiff_t>(end));
    if (const auto prior = startingBelief(measurements[first].stamp, window, config.start, config.model.current_sigma))
      return Start{first, *prior};
  }
  return std::nullopt;
}

}  // namespace

std::optional<SmoothingProblem> buildProblem(const std::vector<Measurement>& measurements, const Config& config) {
  const auto start = findStart(measurements, config);
  if (!start) return std::nullopt;

  SmoothingProblem problem{Model(config.model), start->prior, {}, {}, {}, {}, {}, {}};
  const RobustKalmanFilter<kStates> filter(config.filters.robust_kf);
  Gaussian<kStates> belief = start->prior;
  HeldInput input;
  for (std::size_t i = start->first; i < measurements.size(); ++i) {
    const Measurement& z = measurements[i];
    if (problem.stamps.empty() || z.stamp != problem.stamps.back()) {
      const double dt = problem.stamps.empty() ? 0 : secondsBetween(problem.stamps.back(), z.stamp);
      const Input known = input.at(z.stamp, config.input_hold);
      const auto transition = problem.model.transition(belief.mean, known, dt);
      if (!problem.stamps.empty()) belief = filter.predict(belief, transition);
      problem.stamps.push_back(z.stamp);
      problem.inputs.push_back(known);
      problem.Q.push_back(transition.Q);
      problem.initial.push_back(belief.mean);
      problem.first.push_back(problem.measurements.size());
    }
    if (z.sensor == Sensor::TurnRate) {
      input.take(z);
    } else {
      problem.measurements.push_back(z);
      problem.model.linearize(z, belief.mean,
                              [&](const auto& linear) { belief = filter.update(belief, linear).belief; });
      problem.initial.back() = belief.mean;
    }
  }
  problem.first.push_back(problem.measurements.size());
  return problem;
}

double cost(const SmoothingProblem& problem, const Loss& loss, const std::vector<StateVector>& states) {
  double sum = halfSquared(problem.prior.covariance, Model::difference(states[0], problem.prior.mean));
  for (std::size_t k = 0; k < problem.nodes(); ++k) {
    if (k > 0) {
      const StateVector predicted = problem.model.predict(states[k - 1], problem.inputs[k], problem.dt(k));
      sum += halfSquared(problem.Q[k], Model::difference(states[k], predicted));
    }
    for (std::size_t j = problem.first[k]; j < problem.first[k + 1]; ++j)
      problem.model.linearize(problem.measurements[j], states[k], [&](const auto& z) {
        for (int row = 0; row < z.innovation.rows(); ++row)
          sum += loss.rho(z.innovation(row) / std::sqrt(z.R(row, row)));
      });
  }
  return sum;
}

Vector<2> weightsAt(const Measurement& z, const StateVector& x, const Model& model, const Loss& loss) {
  Vector<2> weights = Vector<2>::Ones();
  model.linearize(z, x, [&](const auto& linear) {
    for (int row = 0; row < linear.innovation.rows(); ++row)
      weights(row) = loss.weight(linear.innovation(row) / std::sqrt(linear.R(row, row)));
  });
  return weights;
}

std::vector<Vector<2>> weightsAt(const SmoothingProblem& problem, const Loss& loss,
                                 const std::vector<StateVector>& states) {
  std::vector<Vector<2>> weights(problem.measurements.size());
  for (std::size_t k = 0; k < problem.nodes(); ++k)
    for (std::size_t j = problem.first[k]; j < problem.first[k + 1]; ++j)
      weights[j] = weightsAt(problem.measurements[j], states[k], problem.model, loss);
  return weights;
}

}  // namespace sas_motion::towfish
