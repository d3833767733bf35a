// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// This file is compiled once for each vector instruction set; the best one of the machine is chosen at run time. Lanes
// are the innermost dimension and all others are loops, so the same code serves all sizes.
#include "sas_motion/filters/particles/blocks.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filters/particles/blocks.cpp"
#include "parallel/vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace sas_motion::blocks {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kLanes>;
using Doubles = hn::Vec<D>;

HWY_INLINE Doubles load(const double* from, int element) { return hn::LoadU(D(), from + kLanes * element); }
HWY_INLINE void store(Doubles value, double* to, int element) { hn::StoreU(value, D(), to + kLanes * element); }
HWY_INLINE Doubles all(double value) { return hn::Set(D(), value); }
/// Returns 0 where every x so far was finite, else NaN.
HWY_INLINE Doubles stillFinite(Doubles so_far, Doubles x) { return hn::MulAdd(x, hn::Zero(D()), so_far); }

constexpr int at(int row, int column) { return row * (row + 1) / 2 + column; }

/// Calls `work(lane)` for the first lane of every register of a block.
template <class Work>
HWY_INLINE void forEachPart(const Work& work) {
  for (int lane = 0; lane < kLanes; lane += static_cast<int>(hn::Lanes(D()))) work(lane);
}

HWY_INLINE void spreadPart(const double* root, const double* shared, int states, double* offsets) {
  for (int i = 0; i < states; ++i) {
    double* const row = offsets + kLanes * i * (states + 2);
    auto later = hn::Zero(D());
    store(later, row, 0);
    for (int point = states + 1; point > i + 2; --point) store(later, row, point);
    for (int j = i; j >= 0; --j) {
      const auto step = hn::Mul(all(shared[j]), load(root, at(i, j)));
      store(hn::MulSub(all(j + 1), step, later), row, j + 2);
      later = hn::Add(later, step);
    }
    store(hn::Neg(later), row, 1);
  }
}

HWY_INLINE void averagePart(const double* mean_weights, const double* root_weights, int rows, int points,
                            double* landed, double* mean) {
  for (int i = 0; i < rows; ++i) {
    double* const row = landed + kLanes * i * points;
    const auto reference = load(row, 0);
    auto sum = hn::Zero(D());
    for (int p = 1; p < points; ++p) sum = hn::MulAdd(all(mean_weights[p]), hn::Sub(load(row, p), reference), sum);
    const auto centre = hn::Add(reference, sum);
    for (int p = 0; p < points; ++p) store(hn::Mul(all(root_weights[p]), hn::Sub(load(row, p), centre)), row, p);
    store(centre, mean, i);
  }
}

/// A reflection that makes row j of A zero.
struct Reflector {
  const double* row;
  int count;
  Doubles head, scale;
};

/// Reflects row i of [root, A] and those after it, `Rows` at a time.
template <int Rows>
HWY_INLINE void reflect(const Reflector& reflector, int i, int j, double* root, double* A) {
  Doubles along[Rows];
  double* row[Rows];
  for (int k = 0; k < Rows; ++k) {
    row[k] = A + kLanes * (i + k) * reflector.count;
    along[k] = hn::Mul(reflector.head, load(root, at(i + k, j)));
  }
  for (int p = 0; p < reflector.count; ++p) {
    const auto v = load(reflector.row, p);
    for (int k = 0; k < Rows; ++k) along[k] = hn::MulAdd(load(row[k], p), v, along[k]);
  }
  for (int k = 0; k < Rows; ++k) {
    along[k] = hn::Mul(reflector.scale, along[k]);
    store(hn::NegMulAdd(along[k], reflector.head, load(root, at(i + k, j))), root, at(i + k, j));
  }
  for (int p = 0; p < reflector.count; ++p) {
    const auto v = load(reflector.row, p);
    for (int k = 0; k < Rows; ++k) store(hn::NegMulAdd(along[k], v, load(row[k], p)), row[k], p);
  }
}

HWY_INLINE void addSquaresPart(double* root, int size, double* A, int count) {
  constexpr int kTogether = 4;
  for (int j = 0; j < size; ++j) {
    const double* const row = A + kLanes * j * count;
    auto rest = hn::Zero(D());
    for (int p = 0; p < count; ++p) rest = hn::MulAdd(load(row, p), load(row, p), rest);
    const auto diagonal = load(root, at(j, j)), length = hn::Sqrt(hn::MulAdd(diagonal, diagonal, rest));
    store(length, root, at(j, j));
    const auto any = hn::Gt(rest, hn::Zero(D()));
    const auto head = hn::IfThenElseZero(any, hn::Neg(hn::Div(rest, hn::Add(diagonal, length))));
    const Reflector reflector{row, count, head, hn::IfThenElseZero(any, hn::Div(all(2), hn::MulAdd(head, head, rest)))};
    int i = j + 1;
    for (; i + kTogether <= size; i += kTogether) reflect<kTogether>(reflector, i, j, root, A);
    for (; i < size; ++i) reflect<1>(reflector, i, j, root, A);
  }
}

/// Computes the weighted products of h's deviations with the points', which divided by S_root are (K S_root)^T.
HWY_INLINE void crossMoments(const Conditioning& b, int lane) {
  for (int i = 0; i < b.states; ++i) {
    const double* const offsets = b.offsets + lane + kLanes * i * b.points;
    for (int m = 0; m < b.rows; ++m) {
      const double* const deviations = b.deviations + lane + kLanes * m * b.points;
      auto sum = hn::Zero(D());
      for (int p = 1; p <= i + 2; ++p)  // the centre and the later corners have no offset here
        sum = hn::MulAdd(hn::Mul(all(b.root_weights[p]), load(offsets, p)), load(deviations, p), sum);
      store(sum, b.gain + lane, m * b.states + i);
    }
  }
}

/// Solves for column `column` of S_root^{-1} `matrix`, whose rows have `columns` elements.
HWY_INLINE void solveLower(const double* S_root, int rows, int columns, int column, double* matrix) {
  for (int m = 0; m < rows; ++m) {
    auto sum = load(matrix, m * columns + column);
    for (int k = 0; k < m; ++k) sum = hn::NegMulAdd(load(S_root, at(m, k)), load(matrix, k * columns + column), sum);
    store(hn::Div(sum, load(S_root, at(m, m))), matrix, m * columns + column);
  }
}

/// Subtracts the squares of the gain's rows from the root, as subtractSquare() of math/square_root.hpp does, all of
/// them column by column. Returns 1 where the result is positive definite. Overwrites the gain. [Gill1974]
HWY_INLINE Doubles subtractSquares(double* root, double* gain, int rows, int states) {
  double rotation[3 * kLanes * kMostRows];  // cosine, its inverse, sine
  auto positive = all(1);
  for (int j = 0; j < states; ++j) {
    auto diagonal = load(root, at(j, j));
    for (int m = 0; m < rows; ++m) {
      const auto v = load(gain, m * states + j), square = hn::Mul(hn::Sub(diagonal, v), hn::Add(diagonal, v));
      positive = hn::IfThenElseZero(hn::Gt(square, hn::Zero(D())), positive);
      const auto length = hn::Sqrt(square);
      store(hn::Div(length, diagonal), rotation, 3 * m);
      store(hn::Div(diagonal, length), rotation, 3 * m + 1);
      store(hn::Div(v, diagonal), rotation, 3 * m + 2);
      diagonal = length;
    }
    store(diagonal, root, at(j, j));
    for (int i = j + 1; i < states; ++i) {
      auto value = load(root, at(i, j));
      for (int m = 0; m < rows; ++m) {
        const auto sine = load(rotation, 3 * m + 2), v = load(gain, m * states + i);
        value = hn::Mul(hn::NegMulAdd(sine, v, value), load(rotation, 3 * m + 1));
        store(hn::MulSub(load(rotation, 3 * m), v, hn::Mul(sine, value)), gain, m * states + i);
      }
      store(value, root, at(i, j));
    }
  }
  return positive;
}

HWY_INLINE void conditionPart(const Conditioning& b, double* whitened, int lane) {
  double *const S_root = b.S_root + lane, *const gain = b.gain + lane, *const mean = b.mean + lane,
                *const root = b.root + lane;
  crossMoments(b, lane);
  addSquaresPart(S_root, b.rows, b.deviations + lane, b.points);
  auto nis = hn::Zero(D());
  for (int m = 0; m < b.rows; ++m) store(load(b.innovation + lane, m), whitened, m);
  solveLower(S_root, b.rows, 1, 0, whitened);
  for (int m = 0; m < b.rows; ++m) nis = hn::MulAdd(load(whitened, m), load(whitened, m), nis);
  store(nis, b.nis + lane, 0);
  auto finite = stillFinite(hn::Zero(D()), nis);
  for (int i = 0; i < b.states; ++i) {
    solveLower(S_root, b.rows, b.states, i, gain);
    auto moved = load(mean, i);
    for (int m = 0; m < b.rows; ++m) moved = hn::MulAdd(load(gain, m * b.states + i), load(whitened, m), moved);
    store(moved, mean, i);
    finite = stillFinite(finite, moved);
  }
  const auto positive = subtractSquares(root, gain, b.rows, b.states);
  for (int element = 0; element < at(b.states, 0); ++element) finite = stillFinite(finite, load(root, element));
  store(hn::IfThenElseZero(hn::Eq(finite, hn::Zero(D())), positive), b.done + lane, 0);
}

HWY_INLINE void addSecondMomentsPart(const double* root, const double* offset, const double* weight, int states,
                                     double* sum) {
  const auto w = load(weight, 0);
  for (int i = 0; i < states; ++i)
    for (int j = 0; j <= i; ++j) {
      auto product = hn::Mul(load(offset, i), load(offset, j));
      for (int k = 0; k <= j; ++k) product = hn::MulAdd(load(root, at(i, k)), load(root, at(j, k)), product);
      store(hn::MulAdd(w, product, load(sum, at(i, j))), sum, at(i, j));
    }
}

void spreadHere(const double* root, const double* shared, int states, double* offsets) {
  forEachPart([&](int lane) { spreadPart(root + lane, shared, states, offsets + lane); });
}

void averageHere(const double* mean_weights, const double* root_weights, int rows, int points, double* landed,
                 double* mean) {
  forEachPart([&](int lane) { averagePart(mean_weights, root_weights, rows, points, landed + lane, mean + lane); });
}

void addSquaresHere(double* root, int size, double* A, int count) {
  forEachPart([&](int lane) { addSquaresPart(root + lane, size, A + lane, count); });
}

void conditionHere(const Conditioning& block) {
  double whitened[kLanes * kMostRows];
  forEachPart([&](int lane) { conditionPart(block, whitened, lane); });
}

void addSecondMomentsHere(const double* root, const double* offset, const double* weight, int states, double* sum) {
  forEachPart([&](int lane) { addSecondMomentsPart(root + lane, offset + lane, weight + lane, states, sum + lane); });
}

const char* targetHere() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sas_motion::blocks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sas_motion::blocks {

HWY_EXPORT(spreadHere);
HWY_EXPORT(averageHere);
HWY_EXPORT(addSquaresHere);
HWY_EXPORT(conditionHere);
HWY_EXPORT(addSecondMomentsHere);
HWY_EXPORT(targetHere);

const char* target() { return HWY_DYNAMIC_DISPATCH(targetHere)(); }

void spread(const double* root, const double* shared, int states, double* offsets) {
  HWY_DYNAMIC_DISPATCH(spreadHere)(root, shared, states, offsets);
}

void average(const double* mean_weights, const double* root_weights, int rows, int points, double* landed,
             double* mean) {
  HWY_DYNAMIC_DISPATCH(averageHere)(mean_weights, root_weights, rows, points, landed, mean);
}

void addSquares(double* root, int size, double* A, int count) {
  HWY_DYNAMIC_DISPATCH(addSquaresHere)(root, size, A, count);
}

void condition(const Conditioning& block) { HWY_DYNAMIC_DISPATCH(conditionHere)(block); }

void addSecondMoments(const double* root, const double* offset, const double* weight, int states, double* sum) {
  HWY_DYNAMIC_DISPATCH(addSecondMomentsHere)(root, offset, weight, states, sum);
}

}  // namespace sas_motion::blocks
#endif
