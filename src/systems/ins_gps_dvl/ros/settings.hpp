// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ros/settings.hpp"
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

namespace sas_motion::ros_side {

/// The configuration file of a system with an INS: the estimators' settings, and what ties them to messages. Its
/// `system` says which: the fusion of INS, GPS and DVL (ins_gps_dvl), or SINS and DVL with large attitude errors
/// (sins_dvl).
struct InsSettings : MapSettings {
  ins::Settings estimation;
  ins::EstimatorFactory make;              ///< of the system's estimators
  std::vector<std::string> estimators;     ///< that it knows
  std::string preferred = "robust_ckf27";  ///< live, where none is asked for
  std::string fix_topic = "gnss/fix";
  std::string imu_topic = "imu/data";
  std::string twist_topic = "dvl/twist";
  std::string depth_topic = "depth/pose";
  std::string velocity_topic;  ///< of GNSS, at the start; empty: none

  /// The defaults, of ins_gps_dvl.
  InsSettings();
  /// Throws ConfigError. An empty name gives the defaults.
  static InsSettings fromFile(const std::string& file);

 private:
  void readEstimation(YamlSection& yaml);
};

}  // namespace sas_motion::ros_side
