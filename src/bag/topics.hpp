// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bag/chunk_file.hpp"
#include "systems/ins_gps_dvl/ros/settings.hpp"

namespace sas_motion::ros_side {

/// A topic's name without its leading slash: bags recorded live have one, bags written by tools often not.
inline std::string bareTopic(const std::string& topic) {
  return !topic.empty() && topic[0] == '/' ? topic.substr(1) : topic;
}

/// The topics of a bag that hold the sensors, as the bag spells them; empty where there is none.
struct SensorTopics {
  std::string fix, imu, twist;
};
struct InsTopics : SensorTopics {
  std::string depth, velocity;
};

/// Finds each sensor by its configured topic or, where the bag has no such topic, by its type when only one topic has
/// it. Throws std::runtime_error where there is neither a position nor a heading, or where the choice is ambiguous.
SensorTopics findTopics(const std::vector<BagConnection>& connections, const Settings& settings,
                        const std::string& file);

/// The same for a system with an INS. Throws where a sensor that is enabled has no topic, and names all of those. The
/// velocity of GNSS may be missing, and is found by its name alone.
InsTopics findTopics(const std::vector<BagConnection>& connections, const InsSettings& settings,
                     const std::string& file);

/// Whether a topic is what one of these estimators, or the datum, wrote in an earlier run.
bool isEstimate(const std::string& topic, const std::vector<std::string>& estimators);

}  // namespace sas_motion::ros_side
