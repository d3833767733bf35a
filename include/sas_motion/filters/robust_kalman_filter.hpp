// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

class YamlSection;

struct RobustKalmanOptions {
  Loss loss{LossKind::Huber};      ///< rho2, on measurements whitened by R
  int max_iterations = 10;         ///< 1: the paper's single pass
  double tolerance = 1e-6;         ///< largest change of a weight at the fixed point [-]
  bool robustify_process = false;  ///< estimate W1 too, with the same loss
  bool calibrate = true;  ///< report a calibrated covariance, see CalibratedFilter; not with W1 or a single pass
};
/// Maximum correntropy is the robust filter with a Gaussian kernel exp(-r^2 / 2 bandwidth^2) on both parts: Welsch's
/// loss with c = bandwidth sqrt(2).
RobustKalmanOptions correntropyOptions(double bandwidth);

/// Returns the options. Throws std::invalid_argument where max_iterations < 1 or tolerance is not positive.
RobustKalmanOptions checked(const RobustKalmanOptions& options);

/// Each reads all keys of a section. Both throw ConfigError.
void readOptions(YamlSection yaml, RobustKalmanOptions& options);
void readCorrentropyOptions(YamlSection yaml, RobustKalmanOptions& options);

/// A Kalman filter by M-estimation [Zhu2007, eq 11-19; Cipra1991].
///
/// It minimises sum rho1(P^{-1/2}(x^- - x)) + sum rho2(R^{-1/2}(z - H x)) (15) by iteratively re-weighted least squares
/// from the prediction. A single iteration takes the weights at the prediction, as the paper does. There the process
/// residuals are zero, so W1 = I whatever `robustify_process` is. Redescending losses start from the solution by
/// Huber's loss, found with as many iterations. P^{1/2} is the symmetric root.
template <int N>
class RobustKalmanFilter {
 public:
  using Belief = Gaussian<N>;
  using Options = RobustKalmanOptions;
  static constexpr Guard kGuard = Guard::CalibratedAndReacquiring;

  /// Throws what checked() throws.
  explicit RobustKalmanFilter(const Options& options) : options_(checked(options)) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return predictGaussian(belief, transition);
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

  /// For CalibratedFilter, whose equations hold at the fixed point with W1 = I.
  bool calibrates() const { return options_.calibrate && options_.max_iterations > 1 && !options_.robustify_process; }
  Influence influence(double residual, double) const {
    const double weight = options_.loss.weight(residual);
    return {weight * residual, options_.loss.slope(residual), weight};
  }

 private:
  template <int M>
  Update<Belief, M> updateMeasurementWeights(const Belief& prior, const LinearMeasurement<N, M>& z) const;
  template <int M>
  Update<Belief, M> updateBothWeights(const Belief& prior, const LinearMeasurement<N, M>& z) const;

  Options options_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/robust_kalman_filter.hpp"
