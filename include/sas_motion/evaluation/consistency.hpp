// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <optional>
#include <vector>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Root mean square, 95th percentile and largest of an error's size.
struct ErrorSummary {
  double rmse = 0, p95 = 0, max = 0;
};
ErrorSummary summarize(const std::vector<double>& errors);

/// An average of normalised squared errors (NEES) or innovations (NIS), the 95 % band that it lies in when the
/// covariances are right and the samples independent, and the fraction of single values inside their own 95 % interval.
struct Consistency {
  double mean = 0, degrees = 0, lower = 0, upper = 0, inside = 0;
  std::size_t count = 0;
};
Consistency consistency(const std::vector<double>& values, double degrees);

/// The square of an error over its covariance.
template <int N>
double normalisedSquare(const Vector<N>& error, const Matrix<N>& P) {
  return error.dot(P.llt().solve(error));
}

/// Down-weighting or rejection, compared with the simulator's labels.
struct Detection {
  std::size_t labelled = 0, flagged = 0, hits = 0;

  void add(bool label, bool flag);
  void add(const Detection& other);
  std::optional<double> precision() const;
  std::optional<double> recall() const;
};

}  // namespace sas_motion
