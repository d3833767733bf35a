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

/// Summarises a filter's belief as a Gaussian; this belief is one already.
template <int N>
const Gaussian<N>& gaussian(const Gaussian<N>& belief) {
  return belief;
}

/// Returns the covariance that a filter weighs its prediction with. Beliefs that keep a second covariance overload
/// this.
template <int N>
Matrix<N> ownCovariance(const Gaussian<N>& belief) {
  return belief.covariance;
}

/// Increases the covariance of a belief. Beliefs that keep more than one covariance overload this.
template <int N>
void addCovariance(Gaussian<N>& belief, const Matrix<N>& more) {
  belief.covariance += more;
}

}  // namespace sas_motion
