// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/math/gaussian.hpp"

namespace sas_motion {

/// A Gaussian that keeps a lower triangular root of its covariance, P = root root^T. P may be singular.
template <int N>
struct RootGaussian {
  Vector<N> mean = Vector<N>::Zero();
  Matrix<N> root = Matrix<N>::Identity();
};

template <int N>
Gaussian<N> gaussian(const RootGaussian<N>& belief) {
  return {belief.mean, belief.root * belief.root.transpose()};
}

/// Replaces `root` by the lower triangular root of root root^T + A A^T whose diagonal is not negative. Householder
/// reflections act on [root, A] from the right and keep the root's zeros. No square is formed, so half as many digits
/// suffice. [Golub2013, 5.2; Merwe2001]
template <int N, int Count>
void addSquares(Matrix<N>& root, const Matrix<N, Count>& A) {
  Matrix<Count, N> rows = A.transpose();  // each column is a row of A, contiguous in memory
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

/// Replaces `root` by the root of root root^T - v v^T. Returns false where that is not positive definite; `root` is
/// then invalid. [Gill1974]
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
