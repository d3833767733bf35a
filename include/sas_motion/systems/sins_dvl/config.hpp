// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/ins_gps_dvl/config.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"

namespace sas_motion::sins {

/// Everything that decides an estimate of SINS and DVL beside the messages.
struct Settings {
  Settings();

  Config config;
  ins::Settings shared;  ///< what messages, alignment and session have in common with the fusion of INS, GPS and DVL
};

/// Reads the sections imu, gps, dvl, depth, start, particles and the keys beside them. Throws ConfigError.
void readSettings(YamlSection& yaml, Settings& settings);

// What a scenario and the settings have in common: how wrong a sensor is. Both throw ConfigError.
void readImuErrors(YamlSection& yaml, Parameters& parameters, double& rate);
void readDvlErrors(YamlSection& yaml, Parameters& parameters);

}  // namespace sas_motion::sins
