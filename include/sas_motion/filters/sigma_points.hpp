// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Points that represent a standard normal N-vector: their weighted mean is 0, their weighted covariance the identity.
template <int N, int Count>
struct SigmaPoints {
  Matrix<N, Count> offsets;          ///< xi, a point each column; x + L xi are the points of N(x, L L^T)
  Vector<Count> mean_weights;        ///< add up to 1
  Vector<Count> covariance_weights;  ///< of outer products about the mean
};

/// The 2N points of the third-degree spherical-radial cubature rule: +-sqrt(N) along every axis, all of the same
/// weight. [Arasaratnam2009]
template <int N>
SigmaPoints<N, 2 * N> cubaturePoints() {
  SigmaPoints<N, 2 * N> points;
  points.offsets << std::sqrt(N) * Matrix<N>::Identity(), -std::sqrt(N) * Matrix<N>::Identity();
  points.mean_weights.setConstant(1.0 / (2 * N));
  points.covariance_weights = points.mean_weights;
  return points;
}

/// Options of the scaled unscented transform.
struct UnscentedOptions {
  double alpha = 1;  ///< spread of the points [-]; far below 1 the large weights lose digits
  double beta = 2;   ///< 2 is best for a normal distribution [-]
  double kappa = 0;  ///< [-]
};

/// The mean and 2N points +-alpha sqrt(N + kappa) along every axis. Throws std::invalid_argument where the spread is
/// not positive. [Merwe2004]
template <int N>
SigmaPoints<N, 2 * N + 1> unscentedPoints(const UnscentedOptions& options) {
  const double spread = options.alpha * options.alpha * (N + options.kappa);  // n + lambda
  if (!(spread > 0) || !std::isfinite(spread) || !std::isfinite(options.beta))
    throw std::invalid_argument("alpha^2 (n + kappa) is " + std::to_string(spread) +
                                " but must be positive, and beta finite");
  SigmaPoints<N, 2 * N + 1> points;
  points.offsets << Vector<N>::Zero(), std::sqrt(spread) * Matrix<N>::Identity(),
      -std::sqrt(spread) * Matrix<N>::Identity();
  points.mean_weights.setConstant(0.5 / spread);
  points.mean_weights(0) = 1 - N / spread;
  points.covariance_weights = points.mean_weights;
  points.covariance_weights(0) += 1 - options.alpha * options.alpha + options.beta;
  return points;
}

/// The points of the spherical simplex, a type of their own for spread().
template <int N>
struct SimplexPoints : SigmaPoints<N, N + 2> {};

/// The products L xi for all points.
template <int N, int Count>
Matrix<N, Count> spread(const SigmaPoints<N, Count>& points, const Matrix<N>& L) {
  return L * points.offsets;
}

/// The same in N^2 operations: in each dimension all earlier corners of the simplex share the coordinate -c.
template <int N>
Matrix<N, N + 2> spread(const SimplexPoints<N>& points, const Matrix<N>& L) {
  Matrix<N, N + 2> corners;
  Vector<N> later = Vector<N>::Zero();
  for (int j = N; j >= 1; --j) {
    const Vector<N> step = -points.offsets(j - 1, 1) * L.col(j - 1);
    corners.col(j + 1) = j * step - later;
    later += step;
  }
  corners.col(1) = -later;
  corners.col(0).setZero();
  return corners;
}

/// The N + 2 points of the spherical simplex: one at the mean, with weight W0 in [0, 1), and N + 1 at the corners of a
/// simplex about it, sqrt(N / (1 - W0)) away. They are about half as many as the unscented points and exact to the
/// second degree. Throws std::invalid_argument for another W0. [Julier2003]
template <int N>
SimplexPoints<N> simplexPoints(double W0) {
  if (!(W0 >= 0 && W0 < 1))
    throw std::invalid_argument("the weight of the simplex's centre is " + std::to_string(W0) +
                                " but must be at least 0 and below 1");
  const double W1 = (1 - W0) / (N + 1);
  SimplexPoints<N> points;
  points.mean_weights.setConstant(W1);
  points.mean_weights(0) = W0;
  points.covariance_weights = points.mean_weights;
  points.offsets.setZero();
  for (int j = 1; j <= N; ++j) {  // each dimension moves the earlier corners away from a new one
    const double c = 1 / std::sqrt(j * (j + 1) * W1);
    points.offsets.row(j - 1).segment(1, j).setConstant(-c);
    points.offsets(j - 1, j + 1) = j * c;
  }
  return points;
}

}  // namespace sas_motion
