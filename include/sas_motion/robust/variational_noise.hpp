// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// What is believed of the variance of M independent channels, each over its stated variance: inverse gamma densities,
/// by how many readings they rest on and the sum of those readings' normalised squares. [Sarkka2009, Sarkka2013]
///
/// Forgetting makes the estimate late where the noise changes: by 1 / (1 - rho) steps. `trend` 1 takes that back, as
/// far as the change goes on as it did (Brown's double exponential smoothing, of the logarithm); 0 is the literal
/// filter.
template <int M>
class VariationalNoise {
 public:
  /// Begins with an expectation for each channel, as if from this many readings; in the terms of an inverse Wishart's
  /// degrees of freedom u that is u - M - 1.
  explicit VariationalNoise(const Vector<M>& factor = Vector<M>::Ones(), double readings = 20)
      : count_(Vector<M>::Constant(readings)), sum_(readings * factor), late_(factor.array().log()) {}

  /// E[R] over the stated R.
  Vector<M> factor(double trend) const {
    const Vector<M> now = sum_.cwiseQuotient(count_).array().log();
    return (now + trend * (now - late_)).array().exp();
  }

  /// The same expectation, less sure: readings fade by rho in (0, 1].
  VariationalNoise faded(double rho) const {
    VariationalNoise result = *this;
    result.count_ *= rho;
    result.sum_ *= rho;
    return result;
  }

  /// With one more reading in the rows where `present` is 1, the expectation not below 1 / limit or above limit.
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
