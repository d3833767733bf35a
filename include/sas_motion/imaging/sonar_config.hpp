// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// Reads the keys of a sonar, which equal the members of SonarDescription. Throws ConfigError, also where the ping rate
/// undersamples the aperture at `speed` or overlaps echoes; the sentence then says the rate needed.
void readSonar(YamlSection yaml, SonarDescription& sonar);

}  // namespace sas_motion::imaging
