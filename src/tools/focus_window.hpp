// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/imaging/focus_bench.hpp"
#include "tools/focus_input.hpp"

namespace sas_motion {

/// A window of the track with the pings that every trajectory puts into it.
struct FocusPings {
  imaging::FocusWindow window;
  std::vector<double> times;                          ///< of the pings [s]
  std::vector<std::vector<imaging::PingPose>> poses;  ///< of each trajectory, in the frame of the aperture
};

/// Chooses the window and interpolates all trajectories, truth first, at its pings. Throws std::runtime_error: one
/// sentence that names the bag, the key or the topic, where the window is outside the bag, a trajectory has a gap, or
/// the sonar undersamples the aperture.
FocusPings choosePings(const std::string& bag, const std::vector<RecordedTrajectory>& trajectories,
                       const imaging::FocusSettings& settings);

}  // namespace sas_motion
