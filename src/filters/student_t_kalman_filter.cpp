// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/student_t_kalman_filter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion {

void readOptions(YamlSection yaml, StudentTKalmanOptions& options) {
  yaml.number("degrees_of_freedom", options.degrees_of_freedom, {kTiny, 1e9});
  yaml.integer("max_iterations", options.max_iterations, 1, 1000);
  yaml.number("tolerance", options.tolerance, {kTiny, 1});
  yaml.boolean("calibrate", options.calibrate);
  yaml.finish();
}

StudentTKalmanOptions checked(const StudentTKalmanOptions& options) {
  if (!(options.degrees_of_freedom > 0))
    throw std::invalid_argument(
        fmt::format("degrees_of_freedom is {} but must be positive", options.degrees_of_freedom));
  if (options.max_iterations < 1)
    throw std::invalid_argument(fmt::format("max_iterations is {} but must be at least 1", options.max_iterations));
  if (!(options.tolerance > 0))
    throw std::invalid_argument(fmt::format("tolerance is {} but must be positive", options.tolerance));
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, StudentTKalmanFilter)

}  // namespace sas_motion
