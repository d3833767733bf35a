// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/system.hpp"

namespace sas_motion::ros_side {

/// SINS and DVL with large attitude errors, on the messages of a fusion of INS, GNSS and DVL. Throws ConfigError.
std::unique_ptr<System> openSinsDvl(YamlSection& yaml);

}  // namespace sas_motion::ros_side
