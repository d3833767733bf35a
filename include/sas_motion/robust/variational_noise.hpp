// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Inverse gamma densities of the variances of M independent channels, each over its stated variance. A density is
/// stored as a number of readings and the sum of their normalised squares. [Sarkka2009, Sarkka2013]
///
/// Forgetting delays the estimate of changing noise by 1 / (1 - rho) steps. `trend` 1 removes the delay of a steady
/// change (Brown's double exponential smoothing of the logarithm); 0 is the literal filter.
template <int M>
class VariationalNoise {
 public:
  /// Starts with an expectation for each channel, as if it came from this many readings. An inverse Wishart density of
  /// u degrees of freedom has u - M - 1.
  explicit VariationalNoise(const Vector<M>& factor = Vector<M>::Ones(), double readings = 20)
      : count_(Vector<M>::Constant(readings)), sum_(readings * factor), late_(factor.array().log()) {}

  /// E[R] over the stated R.
  Vector<M> factor(double trend) const {
    const Vector<M> now = sum_.cwiseQuotient(count_).array().log();
    return (now + trend * (now - late_)).array().exp();
  }

  /// The same expectation with a larger variance: earlier readings are weighted by rho in (0, 1].
  VariationalNoise faded(double rho) const {
    VariationalNoise result = *this;
    result.count_ *= rho;
    result.sum_ *= rho;
    return result;
  }

  /// Adds a reading in the rows where `present` is 1. The expectation is kept between 1 / limit and limit.
  VariationalNoise with(const Vector<M>& squares, const Vector<M>& present, double limit) const {
    VariationalNoise result = *this;
    result.count_ += present;
    result.sum_ =
        (sum_ + squares.cwiseProduct(present)).cwiseMax(result.count_ / limit).cwiseMin(result.count_ * limit);
    const Vector<M> now = result.sum_.cwiseQuotient(result.count_).array().log();
    result.late_ += (now - late_).cwiseQuotient(result.count_).cwiseProduct(present);
    return result;
  }

 private:
  Vector<M> count_, sum_;
  Vector<M> late_;  // logarithm of the expectation, smoothed once more
};

}  // namespace sas_motion
