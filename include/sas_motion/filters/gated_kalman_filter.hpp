// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/robust/gate.hpp"

namespace sas_motion {

class YamlSection;

struct GatedKalmanOptions {
  double probability = 0.99;  ///< share of good measurements that the gate lets through [-]
};
/// Reads all keys of a section. Throws ConfigError.
void readOptions(YamlSection yaml, GatedKalmanOptions& options);
/// Returns the options. Throws std::invalid_argument where one is out of its range.
GatedKalmanOptions checked(const GatedKalmanOptions& options);

/// A Kalman filter that rejects measurements whose NIS fails a chi-squared gate. Alone it rejects all measurements
/// after a jump of the process; inside a ReacquiringFilter it accepts them again.
template <int N>
class GatedKalmanFilter {
 public:
  using Belief = Gaussian<N>;
  using Options = GatedKalmanOptions;
  static constexpr Guard kGuard = Guard::Reacquiring;

  /// Throws std::invalid_argument where an option is out of its range.
  explicit GatedKalmanFilter(const Options& options) : gate_(checked(options).probability) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return predictGaussian(belief, transition);
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  ChiSquaredGate gate_;
  KalmanFilter<N> kalman_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/gated_kalman_filter.hpp"
