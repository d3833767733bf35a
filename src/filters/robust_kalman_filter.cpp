// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/robust_kalman_filter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "instantiate.hpp"
#include "sas_motion/filters/conditioning.hpp"
#include "whitening.hpp"

namespace sas_motion {
namespace {

const Loss& startingLoss() {
  static const Loss huber(LossKind::Huber);
  return huber;
}

template <int M>
struct Reweighted {
  Vector<M> weights;
  Matrix<M> R;   // L W^{-1} L^T
  int iterations = 0;
  bool converged = false;
};

/// Iterates the weights in the measurement's rows alone: the residual after an update with noise R is nu - H P H^T S^{-1} nu.
template <int M>
Reweighted<M> reweight(const Loss& loss, const Vector<M>& innovation, const Matrix<M>& HPHt, const Whitening<M>& whitening,
                       Vector<M> whitened, int max_iterations, double tolerance) {
  Reweighted<M> result;
  while (result.iterations < max_iterations && !result.converged) {
    ++result.iterations;
    result.weights = weightsOf(loss, whitened);
    result.R = whitening.weighted(result.weights);
    const Innovation<M> S(HPHt + result.R);
    const Vector<M> next = whitening.whiten(innovation - HPHt * S.solve(innovation));
    result.converged = (next - whitened).cwiseAbs().maxCoeff() < tolerance;
    whitened = next;
  }
  return result;
}

}  // namespace

template <int N>
RobustKalmanFilter<N>::RobustKalmanFilter(const Options& options) : options_(options) {
  if (options.max_iterations < 1) throw std::invalid_argument(fmt::format("max_iterations is {} but must be at least 1", options.max_iterations));
  if (!(options.tolerance > 0)) throw std::invalid_argument(fmt::format("tolerance is {} but must be positive", options.tolerance));
}

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  const bool process_weights_act = options_.robustify_process && options_.max_iterations > 1;
  return process_weights_act ? updateBothWeights(prior, z) : updateMeasurementWeights(prior, z);
}

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::updateMeasurementWeights(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  Update<Belief, M> result;
  const Projection<N, M> projection(prior.covariance, z.H);
  const Whitening<M> whitening(z.R);
  result.belief = prior;
  result.innovation = z.innovation;
  result.S = projection.HPHt + z.R;
  const Innovation<M> S(result.S);
  result.nis = z.innovation.dot(S.solve(z.innovation));
  if (!S.valid() || !whitening.valid() || !std::isfinite(result.nis)) {
    result.verdict = Verdict::Invalid;
    return result;
  }
  Vector<M> whitened = whitening.whiten(z.innovation);  // at the prediction
  int spent = 0;
  if (options_.loss.redescending() && options_.max_iterations > 1) {
    const auto huber = reweight(startingLoss(), z.innovation, projection.HPHt, whitening, whitened, options_.max_iterations, options_.tolerance);
    whitened = whitening.whiten(z.innovation - projection.HPHt * Innovation<M>(projection.HPHt + huber.R).solve(z.innovation));
    spent = huber.iterations;
  }
  const auto reweighted = reweight(options_.loss, z.innovation, projection.HPHt, whitening, whitened, options_.max_iterations, options_.tolerance);
  result.belief = condition(prior, projection, reweighted.R, Innovation<M>(projection.HPHt + reweighted.R), z.innovation);
  result.weights = reweighted.weights;
  result.iterations = spent + reweighted.iterations;
  result.converged = reweighted.converged;
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::updateBothWeights(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  Update<Belief, M> result;
  result.belief = prior;
  result.innovation = z.innovation;
  const auto root = symmetricSqrt(prior.covariance);
  const Whitening<M> whitening(z.R);
  result.S = z.H * prior.covariance * z.H.transpose() + z.R;
  const Innovation<M> S(result.S);
  result.nis = z.innovation.dot(S.solve(z.innovation));
  if (!root || !whitening.valid() || !S.valid() || !std::isfinite(result.nis)) {
    result.verdict = Verdict::Invalid;
    return result;
  }
  Vector<N> process_residual = Vector<N>::Zero();  // P^{-1/2}(x - x^-)
  Vector<M> whitened = whitening.whiten(z.innovation);
  Loss loss = options_.loss.redescending() ? startingLoss() : options_.loss;
  result.converged = false;
  for (result.iterations = 0; result.iterations < 2 * options_.max_iterations && !result.converged;) {
    ++result.iterations;
    Vector<N> spread;  // the diagonal of W1^{-1}
    for (int i = 0; i < N; ++i) spread(i) = 1 / std::max(loss.weight(process_residual(i)), Whitening<M>::kLeastWeight);
    result.weights = weightsOf(loss, whitened);
    const Matrix<M> R = whitening.weighted(result.weights);
    const Gaussian<N> weighted_prior{prior.mean, *root * spread.asDiagonal() * *root};  // Pw = P^{1/2} W1^{-1} P^{1/2} (19)
    const Projection<N, M> projection(weighted_prior.covariance, z.H);
    const Innovation<M> Sw(projection.HPHt + R);
    const Vector<M> solved = Sw.solve(z.innovation);
    const Vector<N> next_process = spread.asDiagonal() * (*root * (z.H.transpose() * solved));
    const Vector<M> next = whitening.whiten(z.innovation - projection.HPHt * solved);
    const double moved = std::max((next - whitened).cwiseAbs().maxCoeff(), (next_process - process_residual).cwiseAbs().maxCoeff());
    whitened = next;
    process_residual = next_process;
    result.belief = condition(weighted_prior, projection, R, Sw, z.innovation);
    if (loss.kind() != options_.loss.kind() && (moved < options_.tolerance || result.iterations == options_.max_iterations))
      loss = options_.loss;  // Huber has settled: redescend from there
    else
      result.converged = moved < options_.tolerance;
  }
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(RobustKalmanFilter)

}  // namespace sas_motion
