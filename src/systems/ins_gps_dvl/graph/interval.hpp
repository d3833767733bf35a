// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "systems/ins_gps_dvl/graph/node.hpp"

namespace sas_motion::ins {

/// The readings of the IMU between two nodes, from which the way is integrated anew wherever it begins.
struct InertialInterval {
  struct Piece {
    ImuReading reading;
    Stamp end;  ///< where a node stands between two stamps of the IMU, before the reading's own
  };

  Mechanisation begin;  ///< with the memory of the reading before
  std::vector<Piece> pieces = {};
  Errors gap_variance = Errors::Zero();  ///< what a gap of the IMU adds to the noise, in the model's units squared
  double duration = 0;                   ///< [s]
};

/// Where an interval leads from a node with the constants taken out of its readings, and how fast errors grow on the
/// way.
struct Integrated {
  NavigationState end;
  ErrorModel::Motion motion;  ///< means over the interval
};

/// Integrates an interval. `visit(mechanisation, piece)` follows each piece.
template <class Visit>
Integrated integrate(const InertialInterval& interval, const Node& from, const Constants& constants,
                     const Visit& visit) {
  const Vector<3> drift = kDrift * (constants.head<3>() + from.wandering.head<3>()), bias = kBias * constants.tail<3>();
  Mechanisation ins = interval.begin;
  ins.reset(from.state);
  Integrated result{from.state, {from.state, Vector<3>::Zero(), Matrix<3>::Zero()}};
  Vector<3> velocity_sum = Vector<3>::Zero();
  for (const auto& piece : interval.pieces) {
    const double share = secondsBetween(ins.stamp(), piece.end) / interval.duration;
    ImuReading reading = piece.reading;
    reading.rate_body -= drift;
    reading.force_body -= bias;
    ins.advance(reading, piece.end);
    result.motion.force_nav += share * ins.force_nav();
    result.motion.C_nav_body += share * ins.state().q_nav_body.toRotationMatrix();
    velocity_sum += share * ins.state().velocity_nav;
    visit(ins, piece);
  }
  result.end = result.motion.state = ins.state();
  result.motion.state.velocity_nav = velocity_sum;
  return result;
}

inline Integrated integrate(const InertialInterval& interval, const Node& from, const Constants& constants) {
  return integrate(interval, from, constants, [](const Mechanisation&, const InertialInterval::Piece&) {});
}

}  // namespace sas_motion::ins
