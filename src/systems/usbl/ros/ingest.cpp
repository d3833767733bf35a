// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/ingest.hpp"

namespace sas_motion::ros_side {

void UsblIngest::takeFix(const sensor_msgs::NavSatFix& message) {
  if (!hasPosition(message) || !std::isfinite(message.altitude)) {
    ++counts_.no_fix;
    return;
  }
  if (const auto T = sensorAt(message.header.frame_id))
    builder_.addPosition(stampOf(message.header.stamp), geodeticOf(message), bodyVectorOf(T->translation()));
}

void UsblIngest::takeTransponder(const sensor_msgs::NavSatFix& message) {
  if (const auto id = transponderId(message.header.frame_id))
    builder_.addTransponder(*id, {message.latitude, message.longitude, message.altitude});
  else
    ++counts_.no_id;
}

void UsblIngest::take(const sensor_msgs::Imu& message) {
  const auto T = sensorAt(message.header.frame_id);
  if (!T) return;
  const auto C_map_body = rotationOf(message, *T);
  if (C_map_body)
    builder_.addAttitude(stampOf(message.header.stamp), *C_map_body);
  else
    ++counts_.no_attitude;
}

void UsblIngest::take(const sas_motion::UsblMeasurement& message) {
  const std::string& frame = message.header.frame_id;
  if (builder_.readings() == 0 && (settings_.array_frame.empty() || settings_.array_frame == frame)) {
    array_frame_ = frame;
    if (const auto T = frames_.find(frame)) {
      builder_.setNominal(mountingOf(*T));
      has_nominal_ = true;
    }
  }
  if (frame != array_frame_ || (!settings_.array_frame.empty() && frame != settings_.array_frame)) {
    ++counts_.other_array;
    return;
  }
  builder_.addReading(stampOf(message.header.stamp), message.transponder_id, readingOf(message, settings_));
}

std::optional<Transform> UsblIngest::sensorAt(const std::string& frame) {
  const auto T = frames_.find(frame);
  if (T) return T;
  ++counts_.unknown_frame;
  counts_.frames.insert(frame);
  return std::nullopt;
}

}  // namespace sas_motion::ros_side
