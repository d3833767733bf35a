// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/systems.hpp"

namespace sas_motion {

std::unique_ptr<System> makeImagingSystem(YamlSection& campaign, const std::string&, const ins::EstimatorFactory&) {
  campaign.fail(
      "system",
      "is imaging, which this build has not; install Highway and KissFFT (libhwy-dev, libkissfft-dev) and build again");
}

}  // namespace sas_motion
