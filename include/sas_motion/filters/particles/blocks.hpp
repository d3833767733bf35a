// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The algebra of a square-root filter for a block of particles by vector instructions. Every particle has a lane of
/// its own, independent of the others.
///
/// An element of a vector or matrix is kLanes adjacent numbers, one for each particle. Matrices are stored by rows. A
/// lower triangular root is stored without its upper triangle: element (i, j) has the index i (i + 1) / 2 + j. The best
/// instructions of the machine are chosen at run time (a build without Highway has one lane at a time); results of
/// other machines differ in rounding alone.
namespace sas_motion::blocks {

constexpr int kLanes = 8;
constexpr int kMostRows = 8;  ///< of a measurement

/// Returns the name of the instruction set in use.
const char* target();

/// Computes L xi for the corners of the spherical simplex. In each dimension all earlier corners share the coordinate
/// -c; `shared` holds c. offsets: states x (states + 2).
void spread(const double* root, const double* shared, int states, double* offsets);

/// Computes the means of the images and replaces these by their deviations, each times the root of its weight.
/// `landed`: rows x points; the weights are not in lanes.
void average(const double* mean_weights, const double* root_weights, int rows, int points, double* landed,
             double* mean);

/// Does addSquares() of math/square_root.hpp in each lane. `A`, size x count, is overwritten.
void addSquares(double* root, int size, double* A, int count);

/// Arguments and results of condition().
struct Conditioning {
  int states = 0, rows = 0, points = 0;
  const double* root_weights = nullptr;  ///< of the points; not in lanes
  const double* offsets = nullptr;       ///< of the points from the mean, from spread()
  const double* innovation = nullptr;    ///< rows
  double* deviations = nullptr;          ///< of h, from average(); overwritten
  double* S_root = nullptr;              ///< of the noise, then of the innovation's covariance
  double* gain = nullptr;                ///< workspace, rows x states
  double* mean = nullptr;                ///< of the prior, then of the posterior
  double* root = nullptr;                ///< of the prior, then of the posterior
  double* nis = nullptr;                 ///< one element
  double* done =
      nullptr;  ///< one element: 1, or 0 where a root is singular or not finite; mean and root are then invalid
};

/// Fuses one measurement by a downdate of the root with the columns of K S_root. [Merwe2001]
void condition(const Conditioning& block);

/// sum += weight (root root^T + offset offset^T), lower triangular. `weight`: one element.
void addSecondMoments(const double* root, const double* offset, const double* weight, int states, double* sum);

}  // namespace sas_motion::blocks
