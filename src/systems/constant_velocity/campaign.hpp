// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/campaign.hpp"

namespace sas_motion::constant_velocity {

/// Reads one campaign on the textbook problem. Throws ConfigError.
std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder);

}  // namespace sas_motion::constant_velocity
