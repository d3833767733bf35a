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

/// A USBL array on a vessel that hears a surveyed transponder: how the array is turned and where it sits. [ZhangTao]
/// Body axes are starboard, forward, up; the array's are the same where it is mounted without error.
namespace sas_motion::usbl {

constexpr int kStates = 6;     ///< mounting angles, then the lever arm
constexpr int kUnknowns = 10;  ///< and what may be unknown beside them
constexpr int kChannels = 3;   ///< of a reading

enum Unknown {
  kMountingX,     ///< rotation about starboard, as pitch [rad]
  kMountingY,     ///< about forward, as roll [rad]
  kMountingZ,     ///< about up, clockwise as heading [rad]
  kLeverX,        ///< the array's acoustic centre from the reference point: to starboard [m]
  kLeverY,        ///< forward [m]
  kLeverZ,        ///< up [m]
  kTransponderX,  ///< error of the surveyed transponder: true less surveyed; east [m]
  kTransponderY,  ///< north [m]
  kTransponderZ,  ///< up [m]
  kRangeScale     ///< measured range over the true one, less 1: sound speed assumed over the true one [-]
};

using State = Vector<kStates>;
using Unknowns = Vector<kUnknowns>;

/// mounting_x, ..., range_scale.
const std::array<std::string, kUnknowns>& unknownNames();
inline bool isAngle(int unknown) { return unknown <= kMountingZ; }

/// What of a transponder's direction a reading holds beside the slant range.
enum class Mode {
  DirectionAngles,   ///< angles to the array's starboard and forward axes: what an orthogonal array measures
  DirectionCosines,  ///< their cosines
  AzimuthElevation,  ///< clockwise from forward; up
  Azimuth            ///< no elevation
};

/// direction_angles, direction_cosines, azimuth_elevation, azimuth.
const std::vector<std::string>& modeNames();
/// Throws std::invalid_argument that lists the names where `name` is none of them.
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

/// One reply of the transponder, and where the vessel was.
struct Ping {
  Stamp stamp = 0;
  Matrix<3> C_body_map = Matrix<3>::Identity();  ///< v_body = C v_map
  Vector<3> transponder_map =
      Vector<3>::Zero();  ///< the surveyed transponder from the reference point; east, north, up [m]
  Reading reading;        ///< of direction angles
};

/// The measurement model h: one for filters, smoothers and simulation. [ZhangTao, eq 6 to 9]
class Model {
 public:
  explicit Model(Mode mode = Mode::DirectionAngles) : mode_(mode) {}

  /// h: range and direction in this mode. Below the surface of the array's plane the direction angles tell all.
  Vector<kChannels> predict(const Unknowns& x, const Ping& ping) const;
  Vector<kChannels> predict(const State& x, const Ping& ping) const { return predict(widened(x), ping); }
  /// dh/dx.
  Matrix<kChannels, kUnknowns> jacobian(const Unknowns& x, const Ping& ping) const;
  /// Direction angles in this mode, with their variances to first order; a channel that the mode lacks, or that no
  /// direction can have, is absent. The transponder lies below the array.
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
/// The transponder from the array, in the array's axes [m].
Vector<3> transponderInArray(const Unknowns& x, const Ping& ping);

}  // namespace sas_motion::usbl
