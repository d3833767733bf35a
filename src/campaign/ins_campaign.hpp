// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/campaign/system.hpp"
#include "sas_motion/simulation/ins_scenario.hpp"

namespace sas_motion {

/// Reads what all campaigns on the fusion of INS, GPS and DVL have: scenario, duration, skip, the estimators' names and the laws. Returns the scenario under
/// each law. Throws ConfigError.
std::vector<ins::Scenario> readInsCampaign(YamlSection& campaign, const std::string& folder, System& system);

}  // namespace sas_motion
