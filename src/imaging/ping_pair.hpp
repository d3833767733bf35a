// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "sas_motion/imaging/micronavigation.hpp"

namespace sas_motion::imaging {

using Complex = std::complex<double>;

/// Where two pings are believed to be, and the straight track between them to which their echoes are moved. Ranges are
/// from the track [m].
struct PingPair {
  std::array<PingPose, 2> poses;
  Eigen::Matrix3d C_local_body;                   ///< half-way between the two attitudes
  Eigen::Vector3d origin, forward, across, down;  ///< of the track: middle of all phase centres, and its axes; local
  double bottom = 0;                              ///< [m]
  std::vector<EchoPath> paths;                    ///< of the first ping's receivers, then of the second's
  double sound_speed = 0;                         ///< [m/s]

  PingPair(const SonarDescription& sonar, const PingPose& first, const PingPose& second,
           const MicronavigationOptions& options);

  /// From the track to the bottom at broadside, or at this sine of the angle forward of it; unit vector, local.
  Eigen::Vector3d sight(double range, double along, double sine = 0) const;
  /// Sine of the angle forward of broadside where a channel's beam has its middle.
  double beamSine(std::size_t channel, const Eigen::Vector3d& sight) const {
    return -paths[channel].forward.dot(sight);
  }
  /// Half a channel's path by the bottom at this range from its place on the track, and at this sine of the angle
  /// forward of broadside [m].
  double halfPath(std::size_t channel, double range, double sine) const;
  /// How half a channel's path differs from the one from its place on the track, which is 0: slope and half the second
  /// derivative over the sine [m].
  struct PathShape {
    double slope = 0, curvature = 0;
  };
  PathShape shape(std::size_t channel, double range, double sine) const;
  /// Place along the track of a channel's phase centre, half-way of the echo's flight [m].
  double along(std::size_t channel, double range) const;
  /// How far the second ping's phase centre is from the first's at the time of this range; on the track's axes [m].
  Eigen::Vector3d displacement(double range) const;
};

/// The echoes of both pings on the straight track: channels x samples, at ranges first_range + n * range_step.
struct AlignedLines {
  double first_range = 0, range_step = 0;  ///< [m]
  int samples = 0;
  std::vector<std::vector<Complex>> channels;

  double range(double sample) const { return first_range + sample * range_step; }
};

/// Moves each echo from its believed path to the track, by its delay and its carrier's phase, as is right at broadside.
AlignedLines align(const EchoLines& lines, std::size_t first_line, const SonarDescription& sonar, const PingPair& pair);

}  // namespace sas_motion::imaging
