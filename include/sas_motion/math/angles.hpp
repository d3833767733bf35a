// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace sas_motion {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadPerDeg = kPi / 180.0;

/// Returns the equivalent angle in (-pi, pi] [rad]. NaN stays NaN.
inline double wrapAngle(double angle) {
  if (angle > -kPi && angle <= kPi) return angle;
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

}  // namespace sas_motion
