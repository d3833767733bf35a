// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sas_motion/UsblMeasurement.h>

#include <optional>
#include <string>

#include "ros/messages.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/model.hpp"
#include "sas_motion/systems/usbl/ping_builder.hpp"

/// Conversions between the calibration's axes (starboard, forward, up) and those of REP-103 (forward, port, up).
namespace sas_motion::ros_side {

/// The configuration file of a USBL calibration: settings of estimators, topics and frames.
struct UsblSettings {
  usbl::Config calibration;
  usbl::PingBuilderOptions pings;
  double range_sigma = 0;      ///< where a message states no variance; 0: the range is then absent [m]
  double direction_sigma = 0;  ///< where a message states no variance; 0: the directions are then absent [rad]
  std::string fix_topic = "gnss/fix";
  std::string imu_topic = "imu/data";
  std::string measurement_topic = "usbl/measurement";
  std::string transponder_topic = "usbl/transponder";
  std::string base_frame = "base_link";
  std::string array_frame;  ///< empty: that of the first measurement

  /// Throws ConfigError. An empty name gives the defaults.
  static UsblSettings fromFile(const std::string& file);
};

/// Range, angle to starboard, angle to forward. Without a usable variance a channel takes the settings' or is absent.
usbl::Reading readingOf(const sas_motion::UsblMeasurement& message, const UsblSettings& settings);
/// The message of a reading; its direction variance is that of the first present direction.
sas_motion::UsblMeasurement measurementOf(const usbl::Reading& reading);

usbl::Mounting mountingOf(const Transform& T_base_array);
Transform transformOf(const usbl::Mounting& mounting);
/// The id in a transponder's frame_id; nothing where it is no number.
std::optional<std::uint32_t> transponderId(const std::string& frame_id);

}  // namespace sas_motion::ros_side
