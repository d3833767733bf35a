// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/campaign.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/scenario.hpp"

namespace sas_motion::ins {

/// Reads one campaign on the fusion of INS, GPS and DVL; `folder` is where the files named in it are. Throws
/// ConfigError.
std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make);
/// Reads one campaign that is scored by images. Fails where the build has no imaging.
std::unique_ptr<Campaign> readImagingCampaign(YamlSection& yaml, const std::string& folder,
                                              const EstimatorFactory& make);

/// Reads a law over a scenario.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Scenario& scenario);

/// The configuration of an estimator under a scenario.
Config configOf(const Scenario& scenario);

/// The bound of the groups of the fusion of INS, GPS and DVL, see Campaign::bound(); "outage" is the position at the
/// end of each.
Named<double> insBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

}  // namespace sas_motion::ins
