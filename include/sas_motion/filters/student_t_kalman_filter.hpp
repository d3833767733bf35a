// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

class YamlSection;

struct StudentTKalmanOptions {
  double degrees_of_freedom = 4;  ///< nu [-]
  int max_iterations = 30;
  double tolerance = 1e-6;  ///< largest change of a weight at the fixed point [-]
  bool calibrate = true;    ///< report a calibrated covariance, see CalibratedFilter
};
/// Reads all keys of a section. Throws ConfigError.
void readOptions(YamlSection yaml, StudentTKalmanOptions& options);
/// Returns the options. Throws std::invalid_argument where one is out of its range.
StudentTKalmanOptions checked(const StudentTKalmanOptions& options);

/// A Kalman filter with Student-t measurement noise in every row, by variational Bayes [Agamennoni2012; Piche2012].
///
/// Each row's precision factor lambda = (nu + 1) / (nu + E[e^2] / R), with E[e^2] the squared residual at the posterior
/// plus its variance H P^+ H^T, is iterated to a fixed point from the prediction. For large nu this is the Kalman
/// filter. R is diagonal.
template <int N>
class StudentTKalmanFilter {
 public:
  using Belief = Gaussian<N>;
  using Options = StudentTKalmanOptions;
  static constexpr Guard kGuard = Guard::CalibratedAndReacquiring;

  /// Throws std::invalid_argument where an option is out of its range.
  explicit StudentTKalmanFilter(const Options& options) : options_(checked(options)) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return predictGaussian(belief, transition);
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

  /// For CalibratedFilter: psi(r) = lambda r. `variance` is that of the posterior in this row over R and is held fixed.
  bool calibrates() const { return options_.calibrate; }
  Influence influence(double residual, double variance) const;

 private:
  Options options_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/student_t_kalman_filter.hpp"
