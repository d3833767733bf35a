// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion {

/// How the readings of a sensor are taken from messages.
struct SensorOptions {
  double sigma = 1;               ///< standard deviation where the message has none [m, rad, m/s, rad/s]
  double floor = 0;               ///< the smallest standard deviation taken from a message [same unit]
  bool override_message = false;  ///< use sigma whatever the message states
  double time_offset = 0;         ///< added to the message's stamp [s]
  bool enabled = true;
  double scale = 1;   ///< of a speed or velocity [-]
  double offset = 0;  ///< added to a heading [rad]
};

/// One instrument of a system, of which there may be several of a kind.
struct SourceOptions {
  std::string name;                   ///< in audits, diagnostics, manifest, metrics and services
  std::string topic;                  ///< of its messages
  std::vector<std::string> measures;  ///< kinds of readings, e.g. position
  SensorOptions options;
};

/// What a system can take: kinds of readings, those that are angles, and those that it cannot do without.
struct SourceKinds {
  std::vector<std::string> all, angles, required;
};

/// Reads the list `sources`. `defaults` has the options of each of `kinds.all`. Throws ConfigError, also where two
/// sources have one name, or one topic and kind, and where a required kind has no source.
std::vector<SourceOptions> readSources(YamlSection& yaml, const SourceKinds& kinds,
                                       const std::vector<SensorOptions>& defaults);

}  // namespace sas_motion
