// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/campaign.hpp"
#include "systems/towfish/reference_estimators.hpp"

namespace sas_motion::towfish {

/// Reads one campaign on the towfish; `folder` is where the files named in it are. Throws ConfigError.
std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make);

/// Hands the errors of one estimate to a scorer and its trace.
void score(const Estimate& estimate, const StateVector& truth, EstimatorScorer& scorer);

/// The bound of the towfish's groups under a scenario, see Campaign::bound(). Empty for a survey, whose truth is not
/// drawn from the model.
Named<double> towfishBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

}  // namespace sas_motion::towfish
