// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

/// Running averages of the influence of the readings in one row of a sensor. They start at the values of good,
/// unclipped readings, which are 1 or 0 whatever the leverage.
struct LearnedInfluence {
  double readings = 0;  ///< number of readings in the averages
  double weighted = 1;  ///< square of the influence, times the weight
  double clipped = 0;   ///< square of the influence, times 1 - weight
  double gain = 1;      ///< square of the gain on a change of the reading
};

/// A robust filter's belief with two covariances: the calibrated one, and the filter's own, which weighs its
/// prediction.
template <int N>
struct CalibratedBelief {
  static constexpr int kMaxRows = 4;
  Gaussian<N> state;
  bool started = false;  ///< before that `own` is not used
  Matrix<N> own = Matrix<N>::Zero();
  std::array<std::array<LearnedInfluence, kMaxRows>, kMaxSources> learned{};
};

template <int N>
const Gaussian<N>& gaussian(const CalibratedBelief<N>& belief) {
  return belief.state;
}

template <int N>
Matrix<N> ownCovariance(const CalibratedBelief<N>& belief) {
  return belief.started ? belief.own : belief.state.covariance;
}

template <int N>
void addCovariance(CalibratedBelief<N>& belief, const Matrix<N>& more) {
  belief.state.covariance += more;
  belief.own += more;
}

/// A robust filter that reports a covariance consistent with its errors [Huber1981; Masreliez1977; Stein1981].
///
/// Means and gains are those of the filter to the last bit. A second covariance is propagated with the same gains and
/// with a noise that is estimated from the average influence of the channel's readings. R is diagonal. The filter
/// provides `calibrates()`, which switches this on, and `influence(residual, variance)`.
template <class Filter, int N>
class CalibratedFilter {
 public:
  using Belief = CalibratedBelief<N>;

  explicit CalibratedFilter(const Filter& filter) : filter_(filter) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const;

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  static Gaussian<N> own(const Belief& belief) { return {belief.state.mean, ownCovariance(belief)}; }

  Filter filter_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/calibrated_filter.hpp"
