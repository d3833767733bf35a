// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/calibration/fitter.hpp"
#include "sas_motion/campaign/system.hpp"
#include "sas_motion/campaign/towfish_campaign.hpp"

namespace sas_motion {

/// The systems of a suite, each read from its campaign. Throw ConfigError.
std::unique_ptr<System> makeTowfishSystem(YamlSection& campaign, const std::string& folder, const towfish::EstimatorFactory& make);
std::unique_ptr<System> makeConstantVelocitySystem(YamlSection& campaign);
std::unique_ptr<System> makeUsblSystem(YamlSection& campaign, const std::string& folder, const usbl::FitterFactory& fitters);

/// How a law is named and plotted.
LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process);

}  // namespace sas_motion
