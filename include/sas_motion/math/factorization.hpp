// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <optional>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Lower Cholesky factor L with A = L L^T, or nothing where A is not positive definite or not finite. This is checked
/// in every build.
template <int N>
std::optional<Matrix<N>> choleskyLower(const Matrix<N>& A) {
  const Eigen::LLT<Matrix<N>> llt(A);
  if (llt.info() != Eigen::Success || !A.allFinite()) return std::nullopt;
  return Matrix<N>(llt.matrixL());
}

/// The symmetric square root A^{1/2}, or nothing where A is not positive definite.
template <int N>
std::optional<Matrix<N>> symmetricSqrt(const Matrix<N>& A) {
  if (!A.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(A);
  if (solver.info() != Eigen::Success || !(solver.eigenvalues().minCoeff() > 0)) return std::nullopt;
  return Matrix<N>(solver.operatorSqrt());
}

/// Makes a numerically nearly symmetric matrix exactly symmetric, in place.
template <int N>
void symmetrize(Matrix<N>& A) {
  for (int row = 1; row < N; ++row)
    for (int col = 0; col < row; ++col) A(row, col) = A(col, row) = 0.5 * (A(row, col) + A(col, row));
}

}  // namespace sas_motion
