// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"

namespace sas_motion {

template <int N>
typename MixtureKalmanFilter<N>::Collapse MixtureKalmanFilter<N>::collapse(double innovation, double v,
                                                                           double r) const {
  std::array<double, kScales> exponent, S;
  double largest = -INFINITY;
  for (std::size_t j = 0; j < kScales; ++j) {
    S[j] = v + options_.scales[j] * r;
    exponent[j] = -0.5 * innovation * innovation / S[j];
    if (options_.probabilities[j] > 0) largest = std::max(largest, exponent[j]);
  }
  double total = 0;
  Collapse result{0, 0, 0};
  for (std::size_t j = 0; j < kScales; ++j) {
    if (options_.probabilities[j] == 0) continue;
    const double likelihood = options_.probabilities[j] * std::exp(exponent[j] - largest) / std::sqrt(S[j]);
    total += likelihood;
    result.inverse += likelihood / S[j];
    result.inverse_squared += likelihood / (S[j] * S[j]);
    result.weight += likelihood / options_.scales[j];
  }
  return {result.inverse / total, result.inverse_squared / total, result.weight / total};
}

template <int N>
template <int M>
Update<Gaussian<N>, M> MixtureKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  auto result = examine(prior, z);
  if (result.verdict == Verdict::Invalid) return result;
  Gaussian<N>& belief = result.belief;
  for (int row = 0; row < M; ++row) {
    const Vector<N> Ph = belief.covariance * z.H.row(row).transpose();
    const double v = z.H.row(row).dot(Ph), d = z.innovation(row) - z.H.row(row).dot(belief.mean - prior.mean);
    const Collapse c = collapse(d, v, z.R(row, row));
    belief.mean += Ph * (d * c.inverse);
    const double shrink = c.inverse - d * d * (c.inverse_squared - c.inverse * c.inverse);
    belief.covariance -= (shrink * Ph) * Ph.transpose();
    result.weights(row) = std::min(1.0, c.weight);
  }
  symmetrize(belief.covariance);
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, MixtureKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(extern, MixtureKalmanFilter)

}  // namespace sas_motion
