// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/imaging/focus_bench.hpp"
#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion {

/// A trajectory of a bag; `name` is that of its files.
struct RecordedTrajectory {
  std::string name, topic;
  imaging::Trajectory trajectory;
};

/// Reads the truth, then the estimates of a bag from topics of type nav_msgs/Odometry: NAME/settled where the bag has
/// it, else NAME/odometry; or only the `wanted` ones, each a topic or a NAME. Poses without a finite position or an
/// orientation are left out. Truth is moved to the frame of the estimates where the bag has the topics datum and
/// truth/fix. Throws std::runtime_error with one sentence that names the bag and the topic.
std::vector<RecordedTrajectory> readTrajectories(const std::string& bag, const std::vector<std::string>& wanted);

/// A window of the track and the poses of every trajectory at its pings.
struct FocusPings {
  imaging::FocusWindow window;
  std::vector<double> times;                          ///< of the pings [s]
  std::vector<std::vector<imaging::PingPose>> poses;  ///< of each trajectory, in the frame of the aperture
};

/// Chooses the window and interpolates all trajectories, truth first, at its pings. Throws std::runtime_error with one
/// sentence where the window is outside the bag, a trajectory has a gap, or the sonar undersamples the aperture.
FocusPings choosePings(const std::string& bag, const std::vector<RecordedTrajectory>& trajectories,
                       const imaging::FocusSettings& settings);

/// The measures of all trajectories (JSON).
std::string focusDocument(const imaging::FocusResult& result);
/// The main measures as a table for a terminal.
std::string focusTable(const imaging::FocusResult& result);

}  // namespace sas_motion
