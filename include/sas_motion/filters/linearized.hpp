// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// One time step of a motion model about the belief's mean x: f(x), F = df/dx and the process noise covariance Q.
template <int N>
struct Transition {
  Vector<N> mean;
  Matrix<N> F;
  Matrix<N> Q;
};

/// One measurement z by a sensor model about the prior mean x: the innovation z - h(x) with angles wrapped, H = dh/dx,
/// and the covariance R of the good (uncontaminated) noise.
template <int N, int M>
struct LinearMeasurement {
  static constexpr int kRows = M;
  Vector<M> innovation;
  Matrix<M, N> H;
  Matrix<M> R;
  double time = 0;  ///< stamp [s], for filters that measure durations
  int source = 0;   ///< number of the sensor, below kMaxSources, for filters that keep something of each sensor
};

constexpr int kMaxSources = 16;

}  // namespace sas_motion
