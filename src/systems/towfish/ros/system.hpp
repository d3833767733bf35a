// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/system.hpp"

namespace sas_motion::ros_side {

/// A towfish set up by a configuration file: GNSS fixes, IMU (heading and turn rate) and twists of a log or DVL. Throws
/// ConfigError.
std::unique_ptr<System> openTowfish(YamlSection& yaml);

}  // namespace sas_motion::ros_side
