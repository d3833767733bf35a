// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"
#include "sas_motion/filters/impl/whitening.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"

namespace sas_motion {

/// Huber's loss, from whose solution redescending losses start.
const Loss& startingLoss();

/// Re-weighted least squares in the measurement's rows alone. The residual after an update with noise R is nu - H P H^T
/// S^{-1} nu.
template <int M>
class RowReweighting {
 public:
  RowReweighting(const Vector<M>& innovation, const Matrix<M>& HPHt, const Matrix<M>& R_nominal,
                 const Whitening<M>& noise, const Innovation<M>& S_nominal)
      : R(R_nominal),
        S(S_nominal),
        innovation_(innovation),
        HPHt_(HPHt),
        whitening_(noise),
        whitened_(noise.whiten(innovation)) {}

  /// Iterates until no weight changes by more than the tolerance.
  void iterate(const Loss& loss, int max_iterations, double tolerance) {
    converged = false;
    for (int i = 0; i < max_iterations && !converged; ++i) {
      const Vector<M> next = weightsOf(loss, whitened_);
      const bool same = (next - weights).cwiseAbs().maxCoeff() < tolerance;
      converged = same && iterations > 0;  // in the first pass the residual is still the prediction's
      if (converged) break;
      ++iterations;
      if (!same) {
        weights = next;
        R = whitening_.weighted(weights);
        S = Innovation<M>(HPHt_ + R);
      }
      whitened_ = whitening_.whiten(innovation_ - HPHt_ * S.solve(innovation_));
    }
  }

  Vector<M> weights = Vector<M>::Ones();
  Matrix<M> R;      // L W^{-1} L^T
  Innovation<M> S;  // H P H^T + R
  int iterations = 0;
  bool converged = false;

 private:
  const Vector<M>& innovation_;
  const Matrix<M>& HPHt_;
  const Whitening<M>& whitening_;
  Vector<M> whitened_;
};

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  const bool process_weights_act = options_.robustify_process && options_.max_iterations > 1;
  return process_weights_act ? updateBothWeights(prior, z) : updateMeasurementWeights(prior, z);
}

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::updateMeasurementWeights(const Belief& prior,
                                                                       const LinearMeasurement<N, M>& z) const {
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
  RowReweighting<M> reweighting(z.innovation, projection.HPHt, z.R, whitening, S);
  if (options_.loss.redescending() && options_.max_iterations > 1)
    reweighting.iterate(startingLoss(), options_.max_iterations, options_.tolerance);
  reweighting.iterate(options_.loss, options_.max_iterations, options_.tolerance);
  result.belief = condition(prior, projection, reweighting.R, reweighting.S, z.innovation);
  result.weights = reweighting.weights;
  result.iterations = reweighting.iterations;
  result.converged = reweighting.converged;
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

template <int N>
template <int M>
Update<Gaussian<N>, M> RobustKalmanFilter<N>::updateBothWeights(const Belief& prior,
                                                                const LinearMeasurement<N, M>& z) const {
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
    const Gaussian<N> weighted_prior{prior.mean,
                                     *root * spread.asDiagonal() * *root};  // Pw = P^{1/2} W1^{-1} P^{1/2} (19)
    const Projection<N, M> projection(weighted_prior.covariance, z.H);
    const Innovation<M> Sw(projection.HPHt + R);
    const Vector<M> solved = Sw.solve(z.innovation);
    const Vector<N> next_process = spread.asDiagonal() * (*root * (z.H.transpose() * solved));
    const Vector<M> next = whitening.whiten(z.innovation - projection.HPHt * solved);
    const double moved =
        std::max((next - whitened).cwiseAbs().maxCoeff(), (next_process - process_residual).cwiseAbs().maxCoeff());
    whitened = next;
    process_residual = next_process;
    result.belief = condition(weighted_prior, projection, R, Sw, z.innovation);
    if (loss.kind() != options_.loss.kind() &&
        (moved < options_.tolerance || result.iterations == options_.max_iterations))
      loss = options_.loss;  // Huber's loss has converged: redescend from there
    else
      result.converged = moved < options_.tolerance;
  }
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, RobustKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(extern, RobustKalmanFilter)

}  // namespace sas_motion
