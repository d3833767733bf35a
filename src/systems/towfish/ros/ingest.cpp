// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/ingest.hpp"

namespace sas_motion::ros_side {

Ingest::Ingest(const Settings& settings, const tf2::BufferCore& transforms, Sink sink)
    : settings_(settings),
      sink_(std::move(sink)),
      inbox_(SensorFrames(transforms, settings.base_frame), settings.frame_timeout, kSources) {
  if (settings.datum) setDatum(*settings.datum);
}

void Ingest::take(const sensor_msgs::NavSatFix& message) {
  inbox_.receive(message, kFix, [this](const auto& fix, const Transform& T_base_gnss) {
    if (!frame_ && hasPosition(fix)) setDatum(geodeticOf(fix));
    return frame_ && pass(measurementsOf(fix, *frame_, T_base_gnss, settings_.estimation));
  });
}

void Ingest::take(const sensor_msgs::Imu& message) {
  inbox_.receive(message, kImu, [this](const auto& imu, const Transform& T_base_imu) {
    return pass(measurementsOf(imu, T_base_imu, settings_.estimation));
  });
}

void Ingest::take(const geometry_msgs::TwistWithCovarianceStamped& message) {
  inbox_.receive(message, kTwist, [this](const auto& twist, const Transform& T_base_dvl) {
    return pass(measurementsOf(twist, T_base_dvl, settings_.estimation));
  });
}

bool Ingest::pass(const std::vector<Measurement>& measurements) const {
  for (const auto& z : measurements) sink_(z);
  return !measurements.empty();
}

}  // namespace sas_motion::ros_side
