// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/robust/gate.hpp"

namespace sas_motion {

/// A Gaussian and, for each sensor, how many of its measurements in a row the gate has rejected.
template <int N>
struct GatedBelief {
  Gaussian<N> state;
  std::array<int, kMaxSources> rejected_in_a_row{};
};

template <int N>
const Gaussian<N>& gaussian(const GatedBelief<N>& belief) {
  return belief.state;
}

/// Kalman filter that leaves out measurements whose NIS fails a chi-squared gate, with a reset rule.
///
/// A gate alone locks out after a jump of the process. So once `reset_after` measurements of one sensor have been rejected in a row, the
/// covariance is inflated by NIS / M, so that the latest one is no surprise, and it is fused.
template <int N>
class GatedKalmanFilter {
 public:
  using Belief = GatedBelief<N>;

  struct Options {
    double probability = 0.99;  ///< share of good measurements that the gate lets through [-]
    int reset_after = 10;       ///< rejections in a row of one sensor after which it is believed again
  };

  /// Throws std::invalid_argument where an option is out of its range.
  explicit GatedKalmanFilter(const Options& options);

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return {predictGaussian(belief.state, transition), belief.rejected_in_a_row};
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  Options options_;
  ChiSquaredGate gate_;
  KalmanFilter<N> kalman_;
};

}  // namespace sas_motion
