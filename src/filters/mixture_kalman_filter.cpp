// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/mixture_kalman_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion {

void readOptions(YamlSection yaml, MixtureKalmanOptions& options) {
  readArray(yaml, "scales", options.scales, kTiny);
  readArray(yaml, "probabilities", options.probabilities, 0);
  if (*std::max_element(options.probabilities.begin(), options.probabilities.end()) == 0)
    yaml.fail("probabilities", "must not all be 0");
  yaml.finish();
}

MixtureKalmanOptions checked(const MixtureKalmanOptions& options) {
  for (const double scale : options.scales)
    if (!(scale > 0)) throw std::invalid_argument(fmt::format("scales: {} must be positive", scale));
  for (const double probability : options.probabilities)
    if (!(probability >= 0))
      throw std::invalid_argument(fmt::format("probabilities: {} must not be negative", probability));
  if (!(std::accumulate(options.probabilities.begin(), options.probabilities.end(), 0.0) > 0))
    throw std::invalid_argument("probabilities: at least one must be positive");
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, MixtureKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(, MixtureKalmanFilter)

}  // namespace sas_motion
