// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/config/ins_config.hpp"
#include "sas_motion/ros/settings.hpp"

namespace sas_motion::ros_side {

/// The configuration file of a fusion of INS, GPS and DVL: the estimators' settings, and what ties them to messages.
struct InsSettings : MapSettings {
  ins::Settings estimation;
  std::string fix_topic = "gnss/fix";
  std::string imu_topic = "imu/data";
  std::string twist_topic = "dvl/twist";
  std::string depth_topic = "depth/pose";

  /// Throws ConfigError. An empty name gives the defaults.
  static InsSettings fromFile(const std::string& file);
};

}  // namespace sas_motion::ros_side
