// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The algebra of a square-root filter for a block of particles at once, by vector instructions: every particle has a
/// lane of its own, and what happens in one lane does not touch another.
///
/// An element of a vector or matrix is kLanes numbers beside each other, one a particle. Matrices lie row after row; of
/// a lower triangular root the upper triangle is left out, so that element (i, j) is number i (i + 1) / 2 + j. The best
/// instructions that the machine has are chosen when the program runs; another machine's results differ from these in
/// rounding alone.
namespace sas_motion::blocks {

constexpr int kLanes = 8;
constexpr int kMostRows = 8;  ///< of a measurement

/// Whether there are vector instructions at all; where the library was built without Highway nothing below may be
/// called.
bool available();
/// The name of the instruction set in use.
const char* target();

/// L xi for the corners of the spherical simplex, whose coordinate in all dimensions after its own is -c, `shared` of
/// each dimension. offsets: states x (states + 2).
void spread(const double* root, const double* shared, int states, double* offsets);

/// Means of where points landed, and instead of these their deviations, each times the root of its weight. `landed`:
/// rows x points; weights are not in lanes.
void average(const double* mean_weights, const double* root_weights, int rows, int points, double* landed,
             double* mean);

/// As addSquares of math/square_root.hpp. `A`, size x count, is spoilt.
void addSquares(double* root, int size, double* A, int count);

/// What condition() is told, and answers.
struct Conditioning {
  int states = 0, rows = 0, points = 0;
  const double* root_weights = nullptr;  ///< of the points; not in lanes
  const double* offsets = nullptr;       ///< of the points from the mean, of spread()
  const double* innovation = nullptr;    ///< rows
  double* deviations = nullptr;          ///< of h, of average(); spoilt
  double* S_root = nullptr;              ///< of the noise, then of the innovation's covariance
  double* gain = nullptr;                ///< rows x states of room
  double* mean = nullptr;                ///< of the prior, then of the posterior
  double* root = nullptr;                ///< likewise
  double* nis = nullptr;                 ///< one element
  double* done =
      nullptr;  ///< one element: 1, or 0 where lost rank forbade it or numbers are not finite: mean and root are spoilt
};

/// One measurement, by taking the columns of K S_root out of the root. [Merwe2001]
void condition(const Conditioning& block);

/// sum += weight (root root^T + offset offset^T), lower triangular. `weight`: one element.
void addSecondMoments(const double* root, const double* offset, const double* weight, int states, double* sum);

}  // namespace sas_motion::blocks
