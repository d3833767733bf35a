// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/sins_dvl/scenario.hpp"
#include "systems/ins_gps_dvl/ros/recorder.hpp"

namespace sas_motion {

/// Turns what the simulator of SINS and DVL gives into messages in a bag.
struct SinsRecorder : InsRecorder {
  SinsRecorder(const sins::Scenario& scenario, std::uint64_t seed, ros_side::BagOutput& bag)
      : InsRecorder(
            sins::withoutGps(scenario),
            [&](const ins::Trajectory& trajectory) { return sins::simulate(scenario, trajectory, seed); }, false, bag) {
  }
};

}  // namespace sas_motion
