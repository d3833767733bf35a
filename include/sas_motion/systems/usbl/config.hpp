// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/ping_builder.hpp"

namespace sas_motion::usbl {

/// Reads mode and the sections prior, estimate, fit and filters. Throws ConfigError.
void readConfig(YamlSection& yaml, Config& config);
/// Reads the section pings. Throws ConfigError.
void readConfig(YamlSection yaml, PingBuilderOptions& options);
/// Reads `key`, the name of a mode. Throws ConfigError.
void readMode(YamlSection& yaml, const std::string& key, Mode& mode);

}  // namespace sas_motion::usbl
