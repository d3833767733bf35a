// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "sas_motion/systems/sins_dvl/model.hpp"

namespace sas_motion::sins {

/// A towed body with SINS, DVL and a depth gauge.
struct Scenario {
  std::string name;
  double duration = 300;  ///< [s]
  ins::Track track;
  Parameters parameters;
  double imu_rate = 100;  ///< [1/s]
  ins::Scenario::Readings dvl{1, {}, {}}, depth{1, {}, {}};
  bool misaligned_by_sigma =
      false;  ///< tilt and heading begin wrong by just their standard deviations, of either sign; else drawn

  /// Throws ConfigError.
  static Scenario fromFile(const std::string& file);
  static Scenario read(YamlSection yaml);
};

/// What a run is simulated from and scored against: motion, and the same sensors for the 27-state fusion.
ins::Scenario withoutGps(const Scenario& scenario);

/// Draws a run: the IMU by (0.4) with constants and white noise, the DVL by (B.5). The same scenario and seed
/// give the same numbers.
ins::Recording simulate(const Scenario& scenario, const ins::Trajectory& trajectory, std::uint64_t seed);

}  // namespace sas_motion::sins
