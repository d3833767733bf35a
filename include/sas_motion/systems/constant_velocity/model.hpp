// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/linearized.hpp"

/// The textbook problem on which filters are compared without anything else in the way: linear, three axes of position
/// and velocity, white acceleration [BarShalom2001, 6.2.2]. All positions and the velocity of the first axis are
/// measured.
namespace sas_motion::constant_velocity {

constexpr int kStates = 6;  ///< position [m], then velocity [m/s]
constexpr int kRows = 4;    ///< three positions [m], then the first axis' velocity [m/s]

struct Model {
  double step = 0.5;            ///< of an epoch [s]
  double acceleration = 0.05;   ///< power spectral density [m^2/s^3]
  double position_sigma = 1;    ///< of a measurement [m]
  double velocity_sigma = 0.2;  ///< of a measurement [m/s]

  Transition<kStates> transition(const Vector<kStates>& x) const {
    Transition<kStates> result;
    result.F.setIdentity();
    result.Q.setZero();
    for (int axis = 0; axis < 3; ++axis) {
      result.F(axis, axis + 3) = step;
      result.Q(axis, axis) = acceleration * step * step * step / 3;
      result.Q(axis, axis + 3) = result.Q(axis + 3, axis) = acceleration * step * step / 2;
      result.Q(axis + 3, axis + 3) = acceleration * step;
    }
    result.mean = result.F * x;
    return result;
  }

  LinearMeasurement<kStates, kRows> measurement(const Vector<kRows>& z, const Vector<kStates>& x, double time) const {
    LinearMeasurement<kStates, kRows> result;
    result.innovation = z - x.head<kRows>();
    result.H.setIdentity();
    result.R = sigma().cwiseAbs2().asDiagonal();
    result.time = time;
    return result;
  }

  Vector<kRows> sigma() const { return {position_sigma, position_sigma, position_sigma, velocity_sigma}; }
};

}  // namespace sas_motion::constant_velocity
