// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ros/inbox.hpp"
#include "systems/usbl/ros/conversions.hpp"

namespace sas_motion::ros_side {

/// Turns messages into the pings of a calibration, live and from a bag; finds the mountings of antenna, attitude sensor
/// and array by tf2, and counts refused messages. The transform to the array's frame at the first measurement, if there
/// is one, is the nominal mounting.
class UsblIngest {
 public:
  /// Messages without use; the builder counts readings that gave no ping.
  struct Counts {
    std::uint64_t no_fix = 0;         ///< GNSS messages without a position
    std::uint64_t no_attitude = 0;    ///< attitude messages without an orientation
    std::uint64_t unknown_frame = 0;  ///< messages of a frame without a transform to the base frame
    std::uint64_t other_array = 0;    ///< measurements of another array
    std::uint64_t no_id = 0;          ///< transponders whose frame_id is no number
    std::set<std::string> frames;     ///< unknown frames
  };

  /// `transforms` outlives the ingest.
  UsblIngest(const UsblSettings& settings, const tf2::BufferCore& transforms)
      : settings_(settings), frames_(transforms, settings.base_frame), builder_(settings.pings) {}

  void takeFix(const sensor_msgs::NavSatFix& message);
  void takeTransponder(const sensor_msgs::NavSatFix& message);
  void take(const sensor_msgs::Imu& message);
  void take(const sas_motion::UsblMeasurement& message);

  usbl::PingBuilder& builder() { return builder_; }
  const usbl::PingBuilder& builder() const { return builder_; }
  const Counts& counts() const { return counts_; }
  /// Frame of the array that is calibrated; empty before its first measurement.
  const std::string& arrayFrame() const { return array_frame_; }
  bool hasNominal() const { return has_nominal_; }

 private:
  /// A sensor's mounting; counts unknown frames.
  std::optional<Transform> sensorAt(const std::string& frame);

  UsblSettings settings_;
  SensorFrames frames_;
  usbl::PingBuilder builder_;
  Counts counts_;
  std::string array_frame_;
  bool has_nominal_ = false;
};

}  // namespace sas_motion::ros_side
