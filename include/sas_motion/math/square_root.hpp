// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/math/gaussian.hpp"

namespace sas_motion {

/// A belief about an N-vector by a root of its covariance: P = root root^T, lower triangular. P may have lost rank.
template <int N>
struct RootGaussian {
  Vector<N> mean = Vector<N>::Zero();
  Matrix<N> root = Matrix<N>::Identity();
};

template <int N>
Gaussian<N> gaussian(const RootGaussian<N>& belief) {
  return {belief.mean, belief.root * belief.root.transpose()};
}

/// The lower triangular root of root root^T + A A^T, its diagonal not negative: Householder reflections of [root, A]
/// from the right, each of which leaves the root's zeros alone. Never forms a square, so that half as many digits
/// serve. [Golub2013, 5.2; Merwe2001]
template <int N, int Count>
void addSquares(Matrix<N>& root, const Matrix<N, Count>& A) {
  Matrix<Count, N> rows = A.transpose();  // a row of A each column, as they lie in memory one after the other
  for (int j = 0; j < N; ++j) {
    const Vector<Count> reflector = rows.col(j);
    const double diagonal = root(j, j), rest = reflector.squaredNorm();
    const double length = std::sqrt(diagonal * diagonal + rest);
    root(j, j) = length;
    if (!(rest > 0)) continue;
    const double head = -rest / (diagonal + length);  // diagonal - length without cancellation
    const double scale = 2 / (head * head + rest);
    for (int i = j + 1; i < N; ++i) {
      const double along = scale * (head * root(i, j) + rows.col(i).dot(reflector));
      root(i, j) -= along * head;
      rows.col(i) -= along * reflector;
    }
  }
}

/// The root of root root^T - v v^T, or false, with `root` spoilt, where that is not positive definite. [Gill1974]
template <int N>
bool subtractSquare(Matrix<N>& root, Vector<N> v) {
  for (int j = 0; j < N; ++j) {
    const double square = (root(j, j) - v(j)) * (root(j, j) + v(j));
    if (!(square > 0)) return false;
    const double length = std::sqrt(square), cosine = length / root(j, j), sine = v(j) / root(j, j);
    root(j, j) = length;
    for (int i = j + 1; i < N; ++i) {
      root(i, j) = (root(i, j) - sine * v(i)) / cosine;
      v(i) = cosine * v(i) - sine * root(i, j);
    }
  }
  return true;
}

}  // namespace sas_motion
