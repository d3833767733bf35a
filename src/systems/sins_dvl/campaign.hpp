// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/campaign.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"

namespace sas_motion::sins {

/// Reads one campaign on SINS and DVL; `folder` is where the files named in it are. Throws ConfigError.
std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make);

/// The bound of the groups of SINS and DVL, see Campaign::bound(); "drift_percent" is the position at the end over the
/// way.
Named<double> sinsBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

}  // namespace sas_motion::sins
