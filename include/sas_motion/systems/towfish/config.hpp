// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>

#include "sas_motion/config/source_options.hpp"
#include "sas_motion/estimate/smoother_options.hpp"
#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/systems/towfish/model.hpp"
#include "sas_motion/systems/towfish/start.hpp"

namespace sas_motion::towfish {

/// Everything that decides an estimate beside the measurements.
struct Config {
  MotionParameters model;
  std::array<SensorOptions, kSensors> sensors{};  ///< by Sensor
  std::vector<SourceOptions>
      sources;  ///< any number of a sensor; none: one of each, from the sections topics and sensors
  StartOptions start;
  double lag = 5;                            ///< late measurements are fused at their own time up to this age [s]
  double max_gap = 10;                       ///< a stamp further ahead of all others is not accepted alone [s]
  double input_hold = 1;                     ///< a turn rate is used this long [s]
  double turn_rate_limit = 30 * kRadPerDeg;  ///< a faster turn rate is invalid [rad/s]

  FilterOptions filters;
  SmootherOptions rts;
  SmootherOptions batch;
  FixedLagOptions fixed_lag;
  double gnc_probability = 0.99;  ///< share of good measurements inside GNC's inlier threshold [-]

  Config();
  SensorOptions& sensor(Sensor which) { return sensors[static_cast<std::size_t>(which)]; }
  const SensorOptions& sensor(Sensor which) const { return sensors[static_cast<std::size_t>(which)]; }
};

/// Reads the sections model, sensors, start, estimators and the keys beside them. Throws ConfigError.
void readConfig(YamlSection& yaml, Config& config);
void readMotionParameters(YamlSection yaml, MotionParameters& parameters);

}  // namespace sas_motion::towfish
