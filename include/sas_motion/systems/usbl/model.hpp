// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sas_motion/math/stamp.hpp"
#include "sas_motion/math/types.hpp"
#include "sas_motion/navigation/attitude.hpp"

/// Mounting angles and lever arm of a USBL array on a vessel, from readings of a surveyed transponder. [ZhangTao]
/// Body axes are starboard, forward, up; an array that is mounted without error has the same axes.
namespace sas_motion::usbl {

constexpr int kStates = 6;     ///< mounting angles, then the lever arm
constexpr int kUnknowns = 10;  ///< the states and further parameters that may be estimated
constexpr int kChannels = 3;   ///< of a reading

enum Unknown {
  kMountingX,     ///< rotation about starboard, as pitch [rad]
  kMountingY,     ///< about forward, as roll [rad]
  kMountingZ,     ///< about up, clockwise as heading [rad]
  kLeverX,        ///< from the reference point to the array's acoustic centre: to starboard [m]
  kLeverY,        ///< forward [m]
  kLeverZ,        ///< up [m]
  kTransponderX,  ///< true less surveyed transponder position: east [m]
  kTransponderY,  ///< north [m]
  kTransponderZ,  ///< up [m]
  kRangeScale     ///< measured over true range, less 1; from the error of the sound speed [-]
};

using State = Vector<kStates>;
using Unknowns = Vector<kUnknowns>;

/// mounting_x, ..., range_scale.
const std::array<std::string, kUnknowns>& unknownNames();
inline bool isAngle(int unknown) { return unknown <= kMountingZ; }

/// Components of a transponder's direction in a reading, beside the slant range.
enum class Mode {
  DirectionAngles,   ///< angles to the array's starboard and forward axes, as an orthogonal array measures
  DirectionCosines,  ///< their cosines
  AzimuthElevation,  ///< clockwise from forward; up
  Azimuth            ///< no elevation
};

/// direction_angles, direction_cosines, azimuth_elevation, azimuth.
const std::vector<std::string>& modeNames();
/// Throws std::invalid_argument that lists the names for an unknown `name`.
Mode modeFromName(const std::string& name);
const std::string& modeName(Mode mode);

/// A slant range [m] and two direction channels. A channel whose variance is not finite and positive is absent.
struct Reading {
  Vector<kChannels> value = Vector<kChannels>::Zero();
  Vector<kChannels> variance = Vector<kChannels>::Zero();

  bool has(int channel) const {
    return std::isfinite(value(channel)) && std::isfinite(variance(channel)) && variance(channel) > 0;
  }
};

/// One reply of the transponder and the vessel's pose.
struct Ping {
  Stamp stamp = 0;
  Matrix<3> C_body_map = Matrix<3>::Identity();   ///< v_body = C v_map
  Vector<3> transponder_map = Vector<3>::Zero();  ///< from the reference point to the survey; east, north, up [m]
  Reading reading;                                ///< of direction angles
};

/// The measurement model h of filters, smoothers and simulation. [ZhangTao, eq 6 to 9]
class Model {
 public:
  explicit Model(Mode mode = Mode::DirectionAngles) : mode_(mode) {}

  /// h: range and direction in this mode.
  Vector<kChannels> predict(const Unknowns& x, const Ping& ping) const;
  Vector<kChannels> predict(const State& x, const Ping& ping) const { return predict(widened(x), ping); }
  /// dh/dx.
  Matrix<kChannels, kUnknowns> jacobian(const Unknowns& x, const Ping& ping) const;
  /// Converts direction angles to this mode, variances to first order, for a transponder below the array. Channels that
  /// the mode lacks and impossible directions become absent.
  Reading convert(const Reading& direction_angles) const;
  /// y - x with angles wrapped.
  Vector<kChannels> difference(const Vector<kChannels>& y, const Vector<kChannels>& x) const;

  Mode mode() const { return mode_; }
  static Unknowns widened(const State& x) { return (Unknowns() << x, Vector<kUnknowns - kStates>::Zero()).finished(); }

 private:
  Mode mode_;
};

/// The array's rotation: v_body = C v_array.
Matrix<3> mountingRotation(const Vector<3>& angles);
/// From the array to the transponder, in the array's axes [m].
Vector<3> transponderInArray(const Unknowns& x, const Ping& ping);

/// Rotation and place of an array on the vessel; the axes of both are starboard, forward, up.
struct Mounting {
  Matrix<3> C_body_array = Matrix<3>::Identity();  ///< v_body = C v_array
  Vector<3> lever_arm_body = Vector<3>::Zero();    ///< from the reference point to the acoustic centre [m]
};

/// A nominal mounting corrected by a state, whose body axes are those of the nominal array.
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
