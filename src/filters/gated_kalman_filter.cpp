// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gated_kalman_filter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "instantiate.hpp"
#include "sas_motion/filters/conditioning.hpp"

namespace sas_motion {
namespace {

/// The prior with its covariance inflated by NIS / M (its expected value is 1).
template <int N, int M>
Gaussian<N> widened(const Gaussian<N>& prior, double nis) {
  return {prior.mean, prior.covariance * std::max(1.0, nis / M)};
}

double checkedProbability(double probability) {
  if (!(probability > 0 && probability < 1)) throw std::invalid_argument(fmt::format("probability is {} but must lie between 0 and 1", probability));
  return probability;
}

}  // namespace

template <int N>
GatedKalmanFilter<N>::GatedKalmanFilter(const Options& options) : options_(options), gate_(checkedProbability(options.probability)) {
  if (options.reset_after < 1) throw std::invalid_argument(fmt::format("reset_after is {} but must be at least 1", options.reset_after));
}

template <int N>
template <int M>
Update<GatedBelief<N>, M> GatedKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  auto kalman = kalman_.update(prior.state, z);
  Update<Belief, M> result{prior, kalman.innovation, kalman.S, kalman.nis, kalman.weights, 1, true, kalman.verdict};
  if (kalman.verdict == Verdict::Invalid) return result;
  int& rejected = result.belief.rejected_in_a_row[static_cast<std::size_t>(z.source)];
  if (kalman.nis <= gate_.threshold(M)) {
    rejected = 0;
    result.belief.state = kalman.belief;
  } else if (++rejected > options_.reset_after) {
    rejected = 0;
    result.belief.state = kalman_.update(widened<N, M>(prior.state, kalman.nis), z).belief;
  } else {
    result.weights.setZero();
    result.verdict = Verdict::Rejected;
  }
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(GatedKalmanFilter)

}  // namespace sas_motion
