// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

class YamlSection;

struct MixtureKalmanOptions {
  std::array<double, 4> scales{1, 9, 100, 2500};                ///< s_j: variance over R [-]
  std::array<double, 4> probabilities{0.85, 0.05, 0.05, 0.05};  ///< p_j, taken relative to their sum [-]
};
/// Reads all keys of a section. Throws ConfigError.
void readOptions(YamlSection yaml, MixtureKalmanOptions& options);
/// Returns the options. Throws std::invalid_argument where a scale is not positive, a probability negative, or all
/// probabilities are zero.
MixtureKalmanOptions checked(const MixtureKalmanOptions& options);

/// A Kalman filter with Gaussian scale-mixture measurement noise, sum p_j N(0, s_j R) in every row.
///
/// The posterior, a mixture of as many Gaussians as there are scales, is collapsed to its mean and covariance row by
/// row, in closed form: one rank-one update, no iteration [Masreliez1975 for the score-function form; Sorenson1971 for
/// Gaussian sums]. The weight of a reading depends on the prediction and the noise together, and the posterior
/// covariance includes the uncertainty of its scale. R is diagonal. With one scale of 1 this is the Kalman filter.
template <int N>
class MixtureKalmanFilter {
 public:
  using Belief = Gaussian<N>;
  using Options = MixtureKalmanOptions;
  static constexpr Guard kGuard = Guard::Reacquiring;
  static constexpr int kScales = 4;

  /// Throws what checked() throws.
  explicit MixtureKalmanFilter(const Options& options) : options_(checked(options)) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return predictGaussian(belief, transition);
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  /// Expectations over the posterior probabilities of the scales, for an innovation d with predicted variance v and
  /// noise r.
  struct Collapse {
    double inverse;          ///< E[1 / S]
    double inverse_squared;  ///< E[1 / S^2]
    double weight;           ///< E[1 / s]: the row's weight
  };
  Collapse collapse(double innovation, double v, double r) const;

  Options options_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/mixture_kalman_filter.hpp"
