// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"

namespace sas_motion {

template <int N>
template <int M>
Update<Gaussian<N>, M> StudentTKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  Update<Belief, M> result;
  const Projection<N, M> projection(prior.covariance, z.H);
  const Matrix<M>& T = projection.HPHt;
  const Vector<M> variance = z.R.diagonal();
  result.belief = prior;
  result.innovation = z.innovation;
  result.S = T + z.R;
  const Innovation<M> S_nominal(result.S);
  result.nis = z.innovation.dot(S_nominal.solve(z.innovation));
  if (!S_nominal.valid() || !positiveDefinite(z.R) || !std::isfinite(result.nis)) {
    result.verdict = Verdict::Invalid;
    return result;
  }
  const double nu = options_.degrees_of_freedom;
  const auto weights_for = [&](const Vector<M>& squared) -> Vector<M> {
    return (nu + 1) / (nu + squared.cwiseQuotient(variance).array());
  };
  result.weights = weights_for(z.innovation.cwiseAbs2() + T.diagonal());  // at the prediction
  Matrix<M> R = variance.cwiseQuotient(result.weights).asDiagonal();
  result.converged = false;
  for (result.iterations = 0; result.iterations < options_.max_iterations && !result.converged;) {
    ++result.iterations;
    const Innovation<M> S(T + R);
    const Vector<M> residual = z.innovation - T * S.solve(z.innovation);
    const Vector<M> posterior_variance = T.diagonal() - (T * S.solve(T)).diagonal();
    const Vector<M> squared = residual.cwiseAbs2() + posterior_variance;
    const Vector<M> weights = weights_for(squared);
    result.converged = (weights - result.weights).cwiseAbs().maxCoeff() < options_.tolerance;
    result.weights = weights;
    R = variance.cwiseQuotient(weights).asDiagonal();
  }
  result.belief = condition(prior, projection, R, Innovation<M>(T + R), z.innovation);
  result.weights = result.weights.cwiseMin(1.0);  // lambda reaches (nu + 1) / nu, but weights end at 1
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

template <int N>
Influence StudentTKalmanFilter<N>::influence(double residual, double variance) const {
  const double nu = options_.degrees_of_freedom, scale = nu + std::max(0.0, variance),
               spread = scale + residual * residual;
  const double lambda = (nu + 1) / spread;
  return {lambda * residual, lambda * (scale - residual * residual) / spread, std::min(1.0, lambda)};
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, StudentTKalmanFilter)

}  // namespace sas_motion
