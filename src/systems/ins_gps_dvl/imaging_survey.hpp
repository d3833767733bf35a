// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/trajectory.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/imaging_bridge.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion::ins {

/// One synthetic aperture on a line of a survey.
struct Aperture {
  double start = 0;           ///< after the survey's start [s]
  std::vector<Stamp> pings;   ///< since the survey's start
  std::vector<double> times;  ///< of the pings, after the first [s]
  double interval = 0;        ///< from a ping until its last echo [s]
  LocalFrame map;             ///< tangent plane at the middle of the track
  imaging::ApertureFrame frame;
  std::vector<imaging::PingPose> truth;  ///< at the pings, in the frame
};

/// Apertures where the course is straight, spread evenly over the scored time; empty where there is no such stretch.
/// `settings` say how long each is, their start left aside, and its pings.
std::vector<Aperture> chooseApertures(const Scenario& scenario, const Trajectory& trajectory,
                                      const imaging::FocusSettings& settings, double skip, int count);

/// Gathers solutions near one aperture.
class ApertureTrack {
 public:
  /// Keeps a reference to the aperture. `longest_gap` may lie between two solutions [s].
  ApertureTrack(const Aperture& aperture, double longest_gap) : aperture_(&aperture), longest_gap_(longest_gap) {}

  void add(Stamp stamp, const NavigationState& state);
  /// The poses at the pings, in the frame of the aperture; nothing where solutions lie too far apart.
  std::optional<std::vector<imaging::PingPose>> poses(double altitude) const;
  /// What was gathered, in the map of the aperture.
  imaging::Trajectory trajectory() const { return imaging::Trajectory(poses_map_); }

 private:
  const Aperture* aperture_;
  double longest_gap_;
  std::vector<imaging::TimedPose> poses_map_;
};

}  // namespace sas_motion::ins
