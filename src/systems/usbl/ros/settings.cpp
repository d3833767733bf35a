// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/settings.hpp"

namespace sas_motion::ros_side {

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

}  // namespace sas_motion::ros_side
