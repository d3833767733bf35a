// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/systems/usbl/config.hpp"

namespace sas_motion::ros_side {

/// The configuration file of a USBL calibration: the estimators' settings, and what ties them to messages.
struct UsblSettings {
  usbl::Config calibration;
  usbl::PingBuilderOptions pings;
  double range_sigma = 0;      ///< where a message states none; 0: the range is then absent [m]
  double direction_sigma = 0;  ///< where a message states none; 0: the directions are then absent [rad]
  std::string fix_topic = "gnss/fix";
  std::string imu_topic = "imu/data";
  std::string measurement_topic = "usbl/measurement";
  std::string transponder_topic = "usbl/transponder";
  std::string base_frame = "base_link";
  std::string array_frame;  ///< empty: that of the first measurement

  /// Throws ConfigError. An empty name gives the defaults.
  static UsblSettings fromFile(const std::string& file);
};

}  // namespace sas_motion::ros_side
