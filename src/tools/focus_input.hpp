// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion {

/// A trajectory of a bag, and the name that its files have.
struct RecordedTrajectory {
  std::string name, topic;
  imaging::Trajectory trajectory;
};

/// Reads truth, which comes first, and the estimates of a bag from topics of type nav_msgs/Odometry: those named
/// NAME/settled where the bag has it, else NAME/odometry; or only `wanted` ones, each a topic or a NAME. Poses without
/// a finite position or without an orientation are left out. Truth stands in the frame of the estimates, whose origin
/// is the topic datum, where the bag has this and truth/fix; else both share their frame. Throws std::runtime_error:
/// one sentence that names the bag and the topic.
std::vector<RecordedTrajectory> readTrajectories(const std::string& bag, const std::vector<std::string>& wanted);

}  // namespace sas_motion
