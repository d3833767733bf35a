// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

#include "sas_motion/math/types.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Whitens residuals by the Cholesky root R = L L^T, and computes the weighted noise L W^{-1} L^T (19).
template <int M>
class Whitening {
 public:
  explicit Whitening(const Matrix<M>& R) : llt_(R) {}
  bool valid() const { return llt_.info() == Eigen::Success; }
  Vector<M> whiten(const Vector<M>& residual) const { return llt_.matrixL().solve(residual); }
  Matrix<M> weighted(const Vector<M>& weights) const {
    const Matrix<M> L = llt_.matrixL();
    return L * weights.cwiseMax(kLeastWeight).cwiseInverse().asDiagonal() * L.transpose();
  }
  static constexpr double kLeastWeight = 1e-12;  ///< replaces a weight of zero, so that the noise stays finite

 private:
  Eigen::LLT<Matrix<M>> llt_;
};

template <>
class Whitening<1> {
 public:
  explicit Whitening(const Matrix<1>& R) : variance_(R(0, 0)), inverse_root_(1 / std::sqrt(variance_)) {}
  bool valid() const { return variance_ > 0; }
  Vector<1> whiten(const Vector<1>& residual) const { return residual * inverse_root_; }
  Matrix<1> weighted(const Vector<1>& weights) const {
    return Matrix<1>(variance_ / std::max(weights(0), kLeastWeight));
  }
  static constexpr double kLeastWeight = 1e-12;

 private:
  double variance_, inverse_root_;
};

template <int M>
Vector<M> weightsOf(const Loss& loss, const Vector<M>& whitened) {
  Vector<M> weights;
  for (int row = 0; row < M; ++row) weights(row) = loss.weight(whitened(row));
  return weights;
}

}  // namespace sas_motion
