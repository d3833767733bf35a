// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "systems/ins_gps_dvl/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// Why estimators have not started, with the topic that is to blame; empty where they have.
std::string whyNotStarted(const ins::Alignment& alignment, const InsSettings& settings);
/// What is wrong with the data, a sentence each: gaps, wrong rates, wrong stamps, sensors without readings.
std::vector<std::string> remarksOn(const ins::InertialCounts& inertial, const Inbox& inbox,
                                   const InsSettings& settings);

}  // namespace sas_motion::ros_side
