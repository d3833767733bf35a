// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

/// What a row of a sensor has taught of its noise, as its influence shows it: running averages that start from good
/// readings of which nothing is clipped. All are 1 or 0 there, whatever the leverage.
struct LearnedInfluence {
  double readings = 0;  ///< that the averages rest on
  double believed = 1;  ///< square of the influence, the share that was believed
  double clipped = 0;   ///< and the share that was not
  double gain = 1;      ///< square of the gain on a change of the reading
};

/// A robust filter's belief with a calibrated covariance, and the covariance that it weighs its own prediction with.
template <int N>
struct CalibratedBelief {
  static constexpr int kMaxRows = 4;
  Gaussian<N> state;
  bool started = false;  ///< until then the filter's own covariance is the state's
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

/// A robust filter whose covariance says how large its errors are [Huber1981; Masreliez1977; Stein1981].
///
/// Means and gains are those of the filter to the last bit. Beside its own covariance a second one follows the same
/// gains with the noise that they let through, by what the influence of the channel's readings has been on average. R
/// is diagonal. The filter has `calibrates()`, whether it wants this, and `influence(residual, variance)`.
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
