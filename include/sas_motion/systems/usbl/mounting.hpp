// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

/// How an array sits on the vessel; the axes of both are starboard, forward, up.
struct Mounting {
  Matrix<3> C_body_array = Matrix<3>::Identity();  ///< v_body = C v_array
  Vector<3> lever_arm_body = Vector<3>::Zero();    ///< the array's acoustic centre from the reference point [m]
};

/// A nominal mounting corrected by a state whose "body" is the nominal array: first the correction, then the nominal
/// mounting.
inline Mounting corrected(const Mounting& nominal, const State& correction) {
  return {nominal.C_body_array * mountingRotation(correction.head<3>()),
          nominal.lever_arm_body + nominal.C_body_array * correction.tail<3>()};
}

/// The state that corrects a nominal mounting to another.
inline State correctionTo(const Mounting& mounting, const Mounting& nominal) {
  const Attitude angles = attitudeOf(nominal.C_body_array.transpose() * mounting.C_body_array);
  return (State() << angles.pitch, angles.roll, angles.heading,
          nominal.C_body_array.transpose() * (mounting.lever_arm_body - nominal.lever_arm_body))
      .finished();
}

}  // namespace sas_motion::usbl
