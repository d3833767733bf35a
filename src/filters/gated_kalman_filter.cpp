// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gated_kalman_filter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion {

void readOptions(YamlSection yaml, GatedKalmanOptions& options) {
  yaml.number("probability", options.probability, {0.5, 0.999999});
  yaml.finish();
}

GatedKalmanOptions checked(const GatedKalmanOptions& options) {
  if (!(options.probability > 0 && options.probability < 1))
    throw std::invalid_argument(fmt::format("probability is {} but must lie between 0 and 1", options.probability));
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, GatedKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(, GatedKalmanFilter)

}  // namespace sas_motion
