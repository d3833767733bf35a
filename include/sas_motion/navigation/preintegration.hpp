// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion {

/// Readings of an IMU integrated over an interval, whatever the state at its beginning: rotation, velocity and way on
/// the body's axes at the beginning, and their derivatives by drift and bias. Each of many states is then moved in one
/// step. [Forster2017]
class Preintegration {
 public:
  /// Adds means over `dt` [rad/s, m/s^2, s].
  void add(const Vector<3>& rate_body, const Vector<3>& force_body, double dt);

  double duration() const { return duration_; }
  /// The results corrected for a drift eps of the gyros and a bias nabla of the accelerometers, constant over the
  /// interval.
  Eigen::Quaterniond rotation(const Vector<3>& eps) const;
  Vector<3> velocity(const Vector<3>& eps, const Vector<3>& nabla) const {
    return velocity_ + velocity_by_drift_ * eps + velocity_by_bias_ * nabla;
  }
  Vector<3> way(const Vector<3>& eps, const Vector<3>& nabla) const {
    return way_ + way_by_drift_ * eps + way_by_bias_ * nabla;
  }

 private:
  double duration_ = 0;
  Eigen::Quaterniond rotation_ =
      Eigen::Quaterniond::Identity();  // from the body at the end to the body at the beginning
  Vector<3> velocity_ = Vector<3>::Zero(), way_ = Vector<3>::Zero();
  Matrix<3> rotation_by_drift_ = Matrix<3>::Zero();  // a drift turns it by minus this, on the axes at the end
  Matrix<3> velocity_by_drift_ = Matrix<3>::Zero(), way_by_drift_ = Matrix<3>::Zero();
  Matrix<3> velocity_by_bias_ = Matrix<3>::Zero(), way_by_bias_ = Matrix<3>::Zero();
};

}  // namespace sas_motion
