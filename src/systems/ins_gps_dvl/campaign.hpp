// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "campaign/system.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion {

/// Reads what all campaigns on the fusion of INS, GPS and DVL have: scenario, duration, skip, the estimators' names and
/// the laws. Returns the scenario under each law. Throws ConfigError.
std::vector<ins::Scenario> readInsCampaign(YamlSection& campaign, const std::string& folder, System& system);

/// What an estimator of this scenario is told.
ins::Config configOf(const ins::Scenario& scenario);

/// Feeds a recording in time order. What the estimator has to say is added to `output`; `after` is called behind each
/// reading of the inertial unit and at the end, and may clear it.
void replay(ins::Estimator& estimator, const ins::Recording& recording, ins::Output& output,
            const std::function<void()>& after);

}  // namespace sas_motion
