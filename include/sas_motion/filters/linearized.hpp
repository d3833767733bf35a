// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// What a motion model says of one time step, about the belief's mean x: f(x), F = df/dx and the process noise
/// covariance Q.
template <int N>
struct Transition {
  Vector<N> mean;
  Matrix<N> F;
  Matrix<N> Q;
};

/// What a sensor model says of one measurement z, about the prior mean x: the innovation z - h(x) with angles wrapped,
/// H = dh/dx, and the covariance R of the good (uncontaminated) noise.
template <int N, int M>
struct LinearMeasurement {
  static constexpr int kRows = M;
  Vector<M> innovation;
  Matrix<M, N> H;
  Matrix<M> R;
  double time = 0;  ///< when [s], for filters that remember how long something has lasted
  int source = 0;   ///< which sensor, below kMaxSources, for filters that remember something of each
};

constexpr int kMaxSources = 8;

}  // namespace sas_motion
