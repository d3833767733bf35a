// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/campaign.hpp"
#include "systems/usbl/estimate.hpp"

namespace sas_motion::usbl {

/// Reads one campaign on calibrations; `folder` is where the files named in it are. Throws ConfigError.
std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const FitterFactory& fitters);

}  // namespace sas_motion::usbl
