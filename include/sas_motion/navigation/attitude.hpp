// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Pitch (bow up), roll (starboard down) and heading (clockwise from north) of a body whose axes are starboard,
/// forward, up, in a map whose axes are east, north, up [rad].
struct Attitude {
  double pitch = 0, roll = 0, heading = 0;
};

/// The rotation of an attitude: v_map = C v_body = Rz(-heading) Rx(pitch) Ry(roll) v_body. [Titterton2004, 3.6, in
/// these axes]
inline Matrix<3> rotationOf(const Attitude& attitude) {
  using Eigen::AngleAxisd;
  return (AngleAxisd(-attitude.heading, Vector<3>::UnitZ()) * AngleAxisd(attitude.pitch, Vector<3>::UnitX()) *
          AngleAxisd(attitude.roll, Vector<3>::UnitY()))
      .toRotationMatrix();
}

/// The attitude of a rotation. At a pitch of +-90 degrees roll and heading cannot be separated.
inline Attitude attitudeOf(const Matrix<3>& C) {
  return {std::asin(std::clamp(C(2, 1), -1.0, 1.0)), std::atan2(-C(2, 0), C(2, 2)), std::atan2(C(0, 1), C(1, 1))};
}

/// The quaternion of a rotation vector [rad].
inline Eigen::Quaterniond quaternionOf(const Vector<3>& rotation) {
  const double angle = rotation.norm(), half = 0.5 * angle;
  const bool small = angle < 1e-4;  // the series is exact there
  const double sinc = small ? 0.5 - angle * angle / 48 : std::sin(half) / angle,
               cosine = small ? 1 - 0.5 * half * half : std::cos(half);
  return {cosine, sinc * rotation.x(), sinc * rotation.y(), sinc * rotation.z()};
}

/// The matrix [a x] with [a x] b = a x b.
inline Matrix<3> skew(const Vector<3>& a) {
  return (Matrix<3>() << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0).finished();
}

/// Maps components forward, port, up (REP-103) to starboard, forward, up. Its transpose is its inverse.
inline Matrix<3> bodyFromRosBody() { return (Matrix<3>() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(); }

}  // namespace sas_motion
