// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/filters/particles/blocks.hpp"
#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// `Size` numbers for each particle of a block, in the layout of blocks.hpp.
template <int Size>
class Lanes {
 public:
  double* data() { return values_; }
  const double* data() const { return values_; }
  double& operator()(int element, int lane) { return values_[blocks::kLanes * element + lane]; }
  double operator()(int element, int lane) const { return values_[blocks::kLanes * element + lane]; }

  bool finite(int lane) const {
    double none = 0;
    for (int element = 0; element < Size; ++element) none += 0 * (*this)(element, lane);
    return none == 0;
  }

  /// Copies lane `count` - 1 to all lanes after it, so that they hold valid numbers.
  void fillFrom(int count) {
    if (count == blocks::kLanes) return;
    for (int element = 0; element < Size; ++element)
      for (int lane = count; lane < blocks::kLanes; ++lane) (*this)(element, lane) = (*this)(element, count - 1);
  }

 private:
  alignas(64) double values_[blocks::kLanes * Size];
};

template <int Rows, int Cols = 1>
class LaneMatrix : public Lanes<Rows * Cols> {
 public:
  void setColumn(int col, int lane, const Vector<Rows>& column) {
    for (int row = 0; row < Rows; ++row) (*this)(row * Cols + col, lane) = column(row);
  }
  Vector<Rows> column(int col, int lane) const {
    Vector<Rows> column;
    for (int row = 0; row < Rows; ++row) column(row) = (*this)(row * Cols + col, lane);
    return column;
  }
  Matrix<Rows, Cols> matrix(int lane) const {
    Matrix<Rows, Cols> matrix;
    for (int col = 0; col < Cols; ++col) matrix.col(col) = column(col, lane);
    return matrix;
  }
};

/// A lower triangular matrix.
template <int N>
class LaneRoot : public Lanes<N*(N + 1) / 2> {
 public:
  /// Copies from `root(lane)`.
  template <class Roots>
  void set(const Roots& root) {
    const double* from[blocks::kLanes];
    for (int lane = 0; lane < blocks::kLanes; ++lane) from[lane] = root(lane).data();
    for (int col = 0; col < N; ++col)
      for (int row = col; row < N; ++row)
        for (int lane = 0; lane < blocks::kLanes; ++lane) (*this)(at(row, col), lane) = from[lane][N * col + row];
  }
  void setAll(const Matrix<N>& root) {
    set([&](int) -> const Matrix<N>& { return root; });
  }
  /// Copies a lane to the lower triangle of `root`; the rest stays.
  void get(int lane, Matrix<N>& root) const {
    for (int col = 0; col < N; ++col)
      for (int row = col; row < N; ++row) root(row, col) = (*this)(at(row, col), lane);
  }
  /// ln |diagonal|
  double logDeterminant(int lane) const {
    double sum = 0;
    for (int row = 0; row < N; ++row) sum += std::log((*this)(at(row, row), lane));
    return sum;
  }

 private:
  static constexpr int at(int row, int col) { return row * (row + 1) / 2 + col; }
};

}  // namespace sas_motion
