// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// A belief about an N-vector: mean and covariance (symmetric, positive definite).
template <int N>
struct Gaussian {
  Vector<N> mean = Vector<N>::Zero();
  Matrix<N> covariance = Matrix<N>::Identity();
};

/// Every filter's belief can be summarised as a Gaussian; this one is its own summary.
template <int N>
const Gaussian<N>& gaussian(const Gaussian<N>& belief) {
  return belief;
}

/// The covariance that a filter weighs its prediction with; one that keeps another than its summary's has its own.
template <int N>
Matrix<N> ownCovariance(const Gaussian<N>& belief) {
  return belief.covariance;
}

/// Makes a belief less sure; a filter that keeps more than its summary has its own.
template <int N>
void addCovariance(Gaussian<N>& belief, const Matrix<N>& more) {
  belief.covariance += more;
}

}  // namespace sas_motion
