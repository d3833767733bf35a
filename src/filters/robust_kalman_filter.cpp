// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/robust_kalman_filter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "sas_motion/config/yaml_loss.hpp"

namespace sas_motion {

const Loss& startingLoss() {
  static const Loss huber(LossKind::Huber);
  return huber;
}

RobustKalmanOptions correntropyOptions(double bandwidth) {
  RobustKalmanOptions options;
  options.loss = Loss(LossKind::Welsch, bandwidth * std::sqrt(2.0));
  options.robustify_process = true;
  return options;
}

void readOptions(YamlSection yaml, RobustKalmanOptions& options) {
  readLoss(yaml, options.loss);
  yaml.integer("max_iterations", options.max_iterations, 1, 1000);
  yaml.number("tolerance", options.tolerance, {kTiny, 1});
  yaml.boolean("robustify_process", options.robustify_process);
  yaml.boolean("calibrate", options.calibrate);
  yaml.finish();
}

void readCorrentropyOptions(YamlSection yaml, RobustKalmanOptions& options) {
  double bandwidth = options.loss.tuning() / std::sqrt(2.0);
  yaml.number("bandwidth", bandwidth, {kTiny, 1e9});
  yaml.integer("max_iterations", options.max_iterations, 1, 1000);
  yaml.number("tolerance", options.tolerance, {kTiny, 1});
  yaml.finish();
  options.loss = correntropyOptions(bandwidth).loss;
}

RobustKalmanOptions checked(const RobustKalmanOptions& options) {
  if (options.max_iterations < 1)
    throw std::invalid_argument(fmt::format("max_iterations is {} but must be at least 1", options.max_iterations));
  if (!(options.tolerance > 0))
    throw std::invalid_argument(fmt::format("tolerance is {} but must be positive", options.tolerance));
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, RobustKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(, RobustKalmanFilter)

}  // namespace sas_motion
