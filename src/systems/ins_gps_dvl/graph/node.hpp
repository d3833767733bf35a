// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/base/Manifold.h>
#include <gtsam/base/Vector.h>
#include <gtsam/inference/Symbol.h>

#include <array>

#include "sas_motion/systems/ins_gps_dvl/model.hpp"

namespace sas_motion::ins {

constexpr int kNodeStates = 18, kConstantStates = 6;

/// What does not change in a run: gyro drift and accelerometer bias, in the units of ErrorModel. Those of a DVL that is
/// scaled and turned have keys of their own.
using Constants = Vector<kConstantStates>;
const gtsam::Key kConstantsKey = gtsam::Symbol('c', 0);
const gtsam::Key kDvlScaleKey = gtsam::Symbol('s', 0);         ///< double [-]
const gtsam::Key kDvlMisalignmentKey = gtsam::Symbol('t', 0);  ///< Vector3 [rad]
const gtsam::Key kDvlLeverKey = gtsam::Symbol('l', 0);  ///< Vector3, its lever arm minus the configured one; body [m]

/// The body at one time and what wanders, as a variable of a factor graph on the manifold of the error definitions: a
/// step e leads to the state that has the errors e, so that Jacobians are those of ErrorModel, in its units.
struct Node {
  enum { dimension = kNodeStates };

  NavigationState state;
  Vector<9> wandering =
      Vector<9>::Zero();  ///< drift of the gyros, error of the GPS, of the DVL's velocity; as in ErrorModel

  Node retract(const Vector<kNodeStates>& e) const;
  /// The errors that `computed` has where this is the truth.
  Vector<kNodeStates> localCoordinates(const Node& computed) const;
  void print(const std::string& prefix = "") const;
  bool equals(const Node& other, double tolerance) const;
};

/// Which of the 27 errors each coordinate of a node, and of the constants, is.
constexpr std::array<int, kNodeStates> kNodeIndices{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 18, 19, 20, 21, 22, 23};
constexpr std::array<int, kConstantStates> kConstantIndices{9, 10, 11, 15, 16, 17};

/// The estimates as the model's errors: none of the INS, which is taken to be right; drifts, biases and the errors of
/// GPS and DVL.
Errors errorsOf(const Node& node, const Constants& constants);
/// What a filter estimates at a time, as a node and as constants.
Node nodeOf(const NavigationState& fused, const Errors& mean);
Constants constantsOf(const Errors& mean);

}  // namespace sas_motion::ins

template <>
struct gtsam::traits<sas_motion::ins::Node> : public gtsam::internal::Manifold<sas_motion::ins::Node> {};
