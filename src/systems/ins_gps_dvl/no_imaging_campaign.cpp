// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/campaign.hpp"

namespace sas_motion::ins {

std::unique_ptr<Campaign> readImagingCampaign(YamlSection& yaml, const std::string&, const EstimatorFactory&) {
  yaml.fail("system", "is imaging, which this build has not; install KissFFT (libkissfft-dev) and build again");
}

}  // namespace sas_motion::ins
