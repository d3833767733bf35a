// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// The unknown motion of a body in a gap of the IMU, beside the motion that the next reading measures.
struct BridgedGap {
  double force = 1, rate = 0.1;  ///< standard deviations [m/s^2], [rad/s]

  /// Variances of velocity, position and attitude errors from one part of a gap [m^2/s^2, m^2, rad^2]. The parts add up
  /// to the effect of a constant error of force and rate over the whole gap. Times are in seconds.
  Vector<9> variance(double gap, double part) const {
    Vector<9> variance;
    variance.segment<3>(0).setConstant(force * force * gap * part);
    variance.segment<3>(3).setConstant(0.25 * force * force * gap * gap * gap * part);
    variance.segment<3>(6).setConstant(rate * rate * gap * part);
    return variance;
  }
};

}  // namespace sas_motion
