// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/ingest.hpp"

namespace sas_motion::ros_side {

InsIngest::InsIngest(const InsSettings& settings, const tf2::BufferCore& transforms, Sink sink)
    : settings_(settings),
      sink_(std::move(sink)),
      inbox_(SensorFrames(transforms, settings.base_frame), settings.frame_timeout, kSources) {
  if (settings.datum) setDatum(*settings.datum);
  const auto enable = [&](Source source, ins::Sensor sensor) {
    inbox_.enable(source, settings.estimation.of(sensor).enabled);
  };
  enable(kFix, ins::Sensor::Gps);
  enable(kTwist, ins::Sensor::Dvl);
  enable(kDepth, ins::Sensor::Depth);
  inbox_.mayFallSilent(kVelocity);
  if (!settings.estimation.session.alignment.fixes_aid) inbox_.mayFallSilent(kFix);
}

void InsIngest::take(const sensor_msgs::Imu& message) {
  inbox_.receive(message, kImu, [this](const auto& imu, const Transform& T_base_imu) {
    const auto reading = readingOf(imu, T_base_imu, settings_.estimation);
    if (!reading) return false;
    T_base_imu_ = T_base_imu;
    sink_(*reading);
    return true;
  });
}

template <class Message>
void InsIngest::takeAiding(const Message& message, Source source) {
  inbox_.receive(message, source, [this](const Message& m, const Transform& T_base_sensor) -> std::optional<bool> {
    if (!T_base_imu_) return std::nullopt;
    const auto reading = readingOf(m, InsMount{T_base_sensor, *T_base_imu_}, settings_.estimation);
    if (!reading) return false;
    if (!frame_ && reading->sensor == ins::Sensor::Gps) setDatum(geodeticOf(reading->fix));
    sink_(*reading);
    return true;
  });
}

void InsIngest::take(const sensor_msgs::NavSatFix& message) { takeAiding(message, kFix); }
void InsIngest::take(const geometry_msgs::TwistWithCovarianceStamped& message) { takeAiding(message, kTwist); }
void InsIngest::take(const geometry_msgs::PoseWithCovarianceStamped& message) { takeAiding(message, kDepth); }

void InsIngest::takeVelocity(const geometry_msgs::TwistWithCovarianceStamped& message) {
  if (!inbox_.count(message.header, kVelocity)) return;
  if (const auto velocity = groundVelocityOf(message, settings_.estimation))
    sink_(*velocity);
  else
    inbox_.countUnusable(kVelocity);
}

}  // namespace sas_motion::ros_side
