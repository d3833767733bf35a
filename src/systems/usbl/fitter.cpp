// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kMedianOfGood = 0.6744897501960817;  // median of |r| for standard normal r
constexpr int kScaleRounds = 50;
constexpr double kLeastSlope = 0.05;  // bounds the mean slope of a channel with only outliers

/// Normal equations of the weighted residuals, in units of the prior's sigmas; unknowns not estimated have no step.
struct NormalEquations {
  Matrix<kUnknowns> A = Matrix<kUnknowns>::Identity();
  Vector<kUnknowns> b;

  NormalEquations(const Problem& problem, const Loss& loss, const Unknowns& x) {
    const auto& prior = problem.prior;
    b = (prior.mean - x).cwiseQuotient(prior.sigma);
    for (const auto& ping : problem.pings) {
      const Vector<kChannels> residual = normalisedResidual(problem, ping, x);
      const Matrix<kChannels, kUnknowns> H = problem.model.jacobian(x, ping) * prior.sigma.asDiagonal();
      for (int i = 0; i < kChannels; ++i) {
        if (!ping.reading.has(i)) continue;
        const Vector<kUnknowns> row = H.row(i).transpose() / (problem.scale(i) * std::sqrt(ping.reading.variance(i)));
        const double weight = loss.weight(residual(i));
        A += weight * row * row.transpose();
        b += weight * residual(i) * row;
      }
    }
    for (int i = 0; i < kUnknowns; ++i)
      if (!prior.estimated[i]) A.row(i).setZero(), A.col(i).setZero(), A(i, i) = 1, b(i) = 0;
  }
};

/// The scale of each channel from the median of its residuals at x.
Vector<kChannels> scaleAt(const Problem& problem, const Unknowns& x) {
  std::array<std::vector<double>, kChannels> residuals;
  for (const auto& ping : problem.pings) {
    const Vector<kChannels> residual = normalisedResidual(problem, ping, x).cwiseProduct(problem.scale);
    for (int i = 0; i < kChannels; ++i)
      if (ping.reading.has(i)) residuals[i].push_back(std::abs(residual(i)));
  }
  const auto unknowns =
      static_cast<double>(std::count(problem.prior.estimated.begin(), problem.prior.estimated.end(), true));
  Vector<kChannels> scale = problem.scale;
  for (int i = 0; i < kChannels; ++i) {
    const auto& all = residuals[i];
    const double count = static_cast<double>(all.size()), spent = unknowns / kChannels;  // spent: degrees of freedom
    const double median =
        count > 2 * unknowns ? quantile(all, 0.5) / kMedianOfGood * std::sqrt(count / (count - spent)) : 0;
    if (median > 0) scale(i) = median;
  }
  return scale;
}

}  // namespace

Matrix<kUnknowns> influenceCovariance(const Problem& problem, const Loss& loss, const Unknowns& x) {
  const auto& prior = problem.prior;
  Vector<kChannels> slope = Vector<kChannels>::Zero(), count = slope;
  Matrix<kUnknowns> meat = Matrix<kUnknowns>::Zero();
  for (const auto& ping : problem.pings) {
    const Vector<kChannels> residual = normalisedResidual(problem, ping, x);
    const Matrix<kChannels, kUnknowns> H = problem.model.jacobian(x, ping);
    for (int i = 0; i < kChannels; ++i) {
      if (!ping.reading.has(i)) continue;
      slope(i) += loss.slope(residual(i));
      ++count(i);
      const double psi = residual(i) * loss.weight(residual(i)),
                   variance = problem.scale(i) * problem.scale(i) * ping.reading.variance(i);
      meat += psi * psi / variance * H.row(i).transpose() * H.row(i);
    }
  }
  // The slope of a single outlier is 0 or negative; only the mean slope gives an information.
  const Vector<kChannels> mean_slope = slope.cwiseQuotient(count.cwiseMax(1)).cwiseMax(kLeastSlope);
  const Matrix<kUnknowns> bread = covarianceFrom(information(problem, x, mean_slope), prior);
  const Matrix<kUnknowns> known = prior.sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return bread * (meat + known) * bread;
}

std::vector<Vector<kChannels>> weightsAt(const Problem& problem, const Loss& loss, const Unknowns& x) {
  std::vector<Vector<kChannels>> weights;
  weights.reserve(problem.pings.size());
  for (const auto& ping : problem.pings) {
    const Vector<kChannels> residual = normalisedResidual(problem, ping, x);
    weights.emplace_back(Vector<kChannels>::Zero());
    for (int i = 0; i < kChannels; ++i)
      if (ping.reading.has(i)) weights.back()(i) = loss.weight(residual(i));
  }
  return weights;
}

Fit solveIteratively(const Problem& problem, const FitOptions& options, const Unknowns& start) {
  Fit result;
  result.x = start;
  result.scale = problem.scale;
  result.cost = cost(problem, options.loss, start);
  double damping = 0;
  while (!result.converged && result.iterations < options.max_iterations) {
    ++result.iterations;
    NormalEquations equations(problem, options.loss, result.x);
    equations.A.diagonal() *= 1 + damping;
    const Unknowns candidate = result.x + problem.prior.sigma.cwiseProduct(equations.A.llt().solve(equations.b));
    const double candidate_cost = cost(problem, options.loss, candidate);
    if (!std::isfinite(candidate_cost) || candidate_cost > result.cost * (1 + 1e-12)) {
      damping = std::max(10 * damping, 1e-3);
      if (damping > 1e9) break;
      continue;
    }
    result.converged = damping < 1 && result.cost - candidate_cost <= options.tolerance * result.cost;
    result.x = candidate;
    result.cost = candidate_cost;
    damping /= 10;
  }
  if (!result.converged) result.failure = "the fit did not converge";
  result.covariance = influenceCovariance(problem, options.loss, result.x);
  result.weights = weightsAt(problem, options.loss, result.x);
  return result;
}

Fit fit(Problem problem, const FitOptions& options, const Solver& solve) {
  FitOptions stage = options;
  if (options.loss.redescending()) stage.loss = Loss(LossKind::Huber);
  Unknowns x = problem.prior.mean;
  Fit result;
  int iterations = 0;
  for (int round = 0; round < (options.estimate_scale ? kScaleRounds : 1); ++round) {
    if (options.estimate_scale) problem.scale = scaleAt(problem, x);
    result = solve(problem, stage, x);
    iterations += result.iterations;
    if (!result.failure.empty()) return result;
    const Unknowns moved = (result.x - x).cwiseQuotient(problem.prior.sigma);
    x = result.x;
    if (moved.cwiseAbs().maxCoeff() < 1e-9) break;
  }
  if (options.loss.redescending()) result = solve(problem, options, x);
  result.iterations += iterations;
  return result;
}

}  // namespace sas_motion::usbl
