// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/conversions.hpp"

#include <charconv>
#include <limits>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::ros_side {
namespace {

double variance(double stated, double sigma) {
  return usableVariance(stated) || sigma > 0 ? usedVariance(stated, sigma, 0, false)
                                             : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

UsblSettings UsblSettings::fromFile(const std::string& file) {
  UsblSettings settings;
  if (file.empty()) return settings;
  auto yaml = YamlSection::fromFile(file);
  usbl::readConfig(yaml, settings.calibration);
  usbl::readConfig(yaml.section("pings"), settings.pings);
  auto readings = yaml.section("readings");
  readings.number("range_sigma", settings.range_sigma, {0, 1e4});
  readings.angle("direction_sigma_deg", settings.direction_sigma, {0, 90});
  readings.finish();
  auto topics = yaml.section("topics");
  topics.text("fix", settings.fix_topic);
  topics.text("imu", settings.imu_topic);
  topics.text("measurement", settings.measurement_topic);
  topics.text("transponder", settings.transponder_topic);
  topics.finish();
  auto frames = yaml.section("frames");
  frames.text("base", settings.base_frame);
  frames.text("array", settings.array_frame);
  frames.finish();
  yaml.finish();
  return settings;
}

usbl::Reading readingOf(const sas_motion::UsblMeasurement& message, const UsblSettings& settings) {
  const double direction = variance(message.direction_variance, settings.direction_sigma);
  return {{message.slant_range, kPi - message.direction_y, message.direction_x},
          {variance(message.slant_range_variance, settings.range_sigma), direction, direction}};
}

sas_motion::UsblMeasurement measurementOf(const usbl::Reading& reading) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  sas_motion::UsblMeasurement message;
  message.slant_range = reading.value(0);
  message.slant_range_variance = reading.has(0) ? reading.variance(0) : -1;
  message.direction_x = reading.has(2) ? reading.value(2) : kAbsent;
  message.direction_y = reading.has(1) ? kPi - reading.value(1) : kAbsent;
  message.direction_variance = reading.has(1) ? reading.variance(1) : reading.has(2) ? reading.variance(2) : -1;
  return message;
}

usbl::Mounting mountingOf(const Transform& T) {
  const Matrix<3> B = bodyFromRosBody();
  return {B * T.linear() * B.transpose(), B * T.translation()};
}

Transform transformOf(const usbl::Mounting& mounting) {
  const Matrix<3> B = bodyFromRosBody();
  Transform T = Transform::Identity();
  T.linear() = B.transpose() * mounting.C_body_array * B;
  T.translation() = B.transpose() * mounting.lever_arm_body;
  return T;
}

std::optional<std::uint32_t> transponderId(const std::string& frame_id) {
  std::uint32_t id = 0;
  const char* end = frame_id.data() + frame_id.size();
  const auto [last, error] = std::from_chars(frame_id.data(), end, id);
  if (error != std::errc() || last != end) return std::nullopt;
  return id;
}

}  // namespace sas_motion::ros_side
