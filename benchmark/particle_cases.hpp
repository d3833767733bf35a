// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The two cases that particle_answers solves, both textbook examples of a bootstrap filter.
#pragma once

#include <cmath>

#include "answer_cases.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::benchmark {

/// The univariate growth model: x_k = x/2 + 25 x / (1 + x^2) + 8 cos(1.2 k) + w, z = x^2/20 + v. The square hides the
/// sign of x. [Gordon1993, sec. 4.1]
struct Growth {
  static constexpr int kStates = 1, kRows = 1, kSteps = 50;
  static constexpr const char* kName = "growth";
  Vector<1> f(const Vector<1>& state, int k) const {
    const double x = state(0);
    return Vector<1>(x / 2 + 25 * x / (1 + x * x) + 8 * std::cos(1.2 * k));
  }
  Vector<1> h(const Vector<1>& state) const { return Vector<1>(state(0) * state(0) / 20); }
  Vector<1> difference(const Vector<1>& a, const Vector<1>& b) const { return a - b; }

  Gaussian<1> start{Vector<1>(0), Matrix<1>(2)};
  Matrix<1> Q{10}, R{1};
};

/// A target that passes an observer at the origin, who sees its bearing alone: x = east, its velocity, north, its
/// velocity; constant velocity with white acceleration. [Gordon1993, sec. 4.2], with a sharper start and a blunter
/// sensor, so that a thousand particles are enough.
struct Bearings {
  static constexpr int kStates = 4, kRows = 1, kSteps = 24;
  static constexpr const char* kName = "bearings";
  static constexpr double kDensity = 1e-4;  // of the acceleration, a step being 1 s [m^2/s^3]
  Bearings() {
    F << 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1;
    Matrix<2> one_axis;
    one_axis << 1. / 3, 1. / 2, 1. / 2, 1;
    Q << kDensity * one_axis, Matrix<2>::Zero(), Matrix<2>::Zero(), kDensity * one_axis;
    start.mean << -0.05, 0.001, 0.7, -0.055;
    start.covariance.diagonal() << 0.01, 2.5e-5, 0.01, 1e-4;
  }
  Vector<4> f(const Vector<4>& x, int) const { return F * x; }
  Vector<1> h(const Vector<4>& x) const { return Vector<1>(std::atan2(x(2), x(0))); }
  Vector<1> difference(const Vector<1>& a, const Vector<1>& b) const { return Vector<1>(wrapAngle(a(0) - b(0))); }

  Matrix<4> F, Q;
  Matrix<1> R{2.5e-3};
  Gaussian<4> start;
};

}  // namespace sas_motion::benchmark
