// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/bank_kalman_filter.hpp"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion {
namespace {

void require(bool holds, const char* key, double value, const char* must) {
  if (!holds) throw std::invalid_argument(fmt::format("{} is {} but must be {}", key, value, must));
}

}  // namespace

void readOptions(YamlSection yaml, BankKalmanOptions& options) {
  yaml.number("epoch", options.epoch, {1e-3, 3600});
  yaml.number("jump_probability", options.jump_probability, {1e-6, 0.199});
  yaml.number("jump_scale", options.jump_scale, {1, 1e6});
  readArray(yaml, "scales", options.scales, kTiny);
  readArray(yaml, "probabilities", options.probabilities, kTiny);
  yaml.number("sticky", options.sticky, {0, 0.99});
  yaml.number("repeat", options.repeat, {0, 1});
  yaml.number("burst", options.burst, {0, 1e6});
  yaml.number("patience", options.patience, {kTiny, 1e6});
  yaml.finish();
}

BankKalmanOptions checked(BankKalmanOptions options) {
  require(options.epoch > 0, "epoch", options.epoch, "positive");
  require(options.jump_probability > 0 && options.jump_probability < 0.2, "jump_probability", options.jump_probability,
          "between 0 and 0.2");
  require(options.jump_scale >= 1, "jump_scale", options.jump_scale, "at least 1");
  require(options.sticky >= 0 && options.sticky < 1, "sticky", options.sticky, "at least 0 and below 1");
  require(options.repeat >= 0 && options.repeat <= 1, "repeat", options.repeat, "between 0 and 1");
  require(options.burst >= 0, "burst", options.burst, "at least 0");
  require(options.patience > 0, "patience", options.patience, "positive");
  for (const double scale : options.scales) require(scale > 0, "scales", scale, "positive");
  const double sum = std::accumulate(options.probabilities.begin(), options.probabilities.end(), 0.0);
  for (double& p : options.probabilities) {
    require(p > 0, "probabilities", p, "positive");
    p /= sum;
  }
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, BankKalmanFilter)

}  // namespace sas_motion
