// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/preintegration.hpp"

#include "sas_motion/navigation/attitude.hpp"

namespace sas_motion {

void Preintegration::add(const Vector<3>& rate_body, const Vector<3>& force_body, double dt) {
  const Vector<3> turn = rate_body * dt;
  // At the middle of the interval, where the mean force acts.
  const Matrix<3> C = (rotation_ * quaternionOf(0.5 * turn)).toRotationMatrix();
  const Matrix<3> half = quaternionOf(-0.5 * turn).toRotationMatrix();
  const Matrix<3> middle_by_drift = half * rotation_by_drift_ + 0.5 * dt * Matrix<3>::Identity();
  const Vector<3> velocity = C * force_body * dt;
  const Matrix<3> by_drift = C * skew(force_body) * middle_by_drift * dt, by_bias = -C * dt;
  way_ += velocity_ * dt + 0.5 * velocity * dt;
  way_by_drift_ += velocity_by_drift_ * dt + 0.5 * by_drift * dt;
  way_by_bias_ += velocity_by_bias_ * dt + 0.5 * by_bias * dt;
  velocity_ += velocity;
  velocity_by_drift_ += by_drift;
  velocity_by_bias_ += by_bias;
  rotation_ = (rotation_ * quaternionOf(turn)).normalized();
  rotation_by_drift_ = half * middle_by_drift + 0.5 * dt * Matrix<3>::Identity();
  duration_ += dt;
}

Eigen::Quaterniond Preintegration::rotation(const Vector<3>& eps) const {
  return rotation_ * quaternionOf(-(rotation_by_drift_ * eps));
}

}  // namespace sas_motion
