// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

struct MicronavigationOptions {
  double bottom = 0;           ///< height of the bottom, taken as flat [m]
  bool starboard = false;      ///< looks to starboard, else to port
  double search = 0.1;         ///< largest error of the predicted displacement along the line of sight [m]
  int min_overlap = 2;         ///< least number of phase centres that two pings share
  double min_coherence = 0.3;  ///< least coherence of two pings from one place; noise alone has about 0.1
  int threads = 1;
};

enum class MicronavigationVerdict {
  Valid,
  NotFinite,   ///< an echo is not finite
  NoOverlap,   ///< the pings are predicted too far apart to share phase centres
  Incoherent,  ///< the pings' coherence is below min_coherence
  Ambiguous,   ///< the envelope is not precise enough to choose among the carrier's wavelengths
};
const char* describe(MicronavigationVerdict verdict);

/// Motion of the array from one ping to the next: the displacement of its phase centre, the middle between transmitter
/// and receiver array, from `delay` after the first transmission to `delay` after the second, on body axes (x forward,
/// y to port, z up) half-way between the two attitudes. Sigmas are the Cramer-Rao bounds at the measured coherence.
/// [Bellettini2002]
struct Micronavigation {
  MicronavigationVerdict verdict = MicronavigationVerdict::Incoherent;
  double along = 0, along_sigma = 0;                          ///< forward [m]
  double sight = 0, sight_sigma = 0;                          ///< along sight_body, so outwards and down [m]
  double turn = 0, turn_sigma = 0;                            ///< of the array's fore end towards sight_body [rad]
  Eigen::Vector3d sight_body = Eigen::Vector3d::Zero();       ///< unit vector across the array of the least variance
  Eigen::Vector3d correction_body = Eigen::Vector3d::Zero();  ///< displacement less the predicted one [m]
  double delay = 0;                                           ///< half the two-way delay along sight_body [s]
  double coherence = 0;                                       ///< of two pings from one place [-]
  int overlap = 0;                                            ///< phase centres that the pings share
};

/// Displaced phase centre micronavigation [Bellettini2002]: phase centres of two pings at one place receive the same
/// speckle. `first` and `second` are the predicted poses; they must be accurate to `search` across the track and to a
/// fraction of a degree of turn, but not along the track. Echoes are moved from their exact predicted paths to one
/// straight track before they are compared, so the geometry causes no bias. `lines` are range-compressed ones of
/// echoPaths(); their own paths are not read. `ping` is the first of the two.
Micronavigation micronavigate(const EchoLines& lines, std::size_t ping, const SonarDescription& sonar,
                              const PingPose& first, const PingPose& second, const MicronavigationOptions& options);

/// The same for each ping and its next; gives the same bits for any number of threads. Throws std::invalid_argument
/// where lines, poses and receivers do not fit.
std::vector<Micronavigation> micronavigate(const EchoLines& lines, const SonarDescription& sonar,
                                           const std::vector<PingPose>& poses, const MicronavigationOptions& options);

}  // namespace sas_motion::imaging
