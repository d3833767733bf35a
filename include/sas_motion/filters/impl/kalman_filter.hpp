// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"
#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

template <int N>
Gaussian<N> predictGaussian(const Gaussian<N>& belief, const Transition<N>& transition) {
  Gaussian<N> prior;
  prior.mean = transition.mean;
  const Matrix<N> FP = transition.F.lazyProduct(belief.covariance);
  prior.covariance = transition.Q + FP.lazyProduct(transition.F.transpose());
  symmetrize(prior.covariance);
  return prior;
}

template <int N>
template <int M>
Update<Gaussian<N>, M> KalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  Update<Belief, M> result;
  const Projection<N, M> projection(prior.covariance, z.H);
  result.innovation = z.innovation;
  result.S = projection.HPHt + z.R;
  const Innovation<M> S(result.S);
  result.nis = z.innovation.dot(S.solve(z.innovation));
  if (S.valid() && positiveDefinite(z.R) && std::isfinite(result.nis)) {
    result.belief = condition(prior, projection, z.R, S, z.innovation);
  } else {
    result.belief = prior;
    result.verdict = Verdict::Invalid;
  }
  return result;
}

#define SAS_MOTION_INSTANTIATE(KIND, N) \
  KIND template Gaussian<N> predictGaussian(const Gaussian<N>&, const Transition<N>&);
SAS_MOTION_FOR_STATES(extern, SAS_MOTION_INSTANTIATE)
SAS_MOTION_INSTANTIATE(extern, 27)
#undef SAS_MOTION_INSTANTIATE
SAS_MOTION_INSTANTIATE_UPDATES(extern, KalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(extern, KalmanFilter)

}  // namespace sas_motion
