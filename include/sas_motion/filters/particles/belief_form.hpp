// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/math/factorization.hpp"
#include "sas_motion/math/square_root.hpp"

namespace sas_motion {

/// Conversions between mean and root, and the belief of a filter by covariances or by roots.
template <class Belief>
struct BeliefForm;

template <int N>
struct BeliefForm<Gaussian<N>> {
  static Gaussian<N> of(const Vector<N>& mean, const Matrix<N>& root) { return {mean, root * root.transpose()}; }
  static std::optional<Matrix<N>> root(const Gaussian<N>& belief) { return choleskyLower<N>(belief.covariance); }
  static void scale(Gaussian<N>& belief, double variance) { belief.covariance *= variance; }
  static void widen(Gaussian<N>& belief, const Matrix<N>& root) { belief.covariance += root * root.transpose(); }
  template <int M>
  static Matrix<M> noise(const Matrix<M>& root) {
    return root * root.transpose();
  }
};

template <int N>
struct BeliefForm<RootGaussian<N>> {
  static RootGaussian<N> of(const Vector<N>& mean, const Matrix<N>& root) { return {mean, root}; }
  static std::optional<Matrix<N>> root(const RootGaussian<N>& belief) { return belief.root; }
  static void scale(RootGaussian<N>& belief, double variance) { belief.root *= std::sqrt(variance); }
  static void widen(RootGaussian<N>& belief, const Matrix<N>& root) { addSquares<N, N>(belief.root, root); }
  template <int M>
  static const Matrix<M>& noise(const Matrix<M>& root) {
    return root;
  }
};

}  // namespace sas_motion
