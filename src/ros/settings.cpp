// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/ros/settings.hpp"

#include <cmath>

namespace sas_motion::ros_side {

Settings Settings::fromFile(const std::string& file) {
  Settings settings;
  if (file.empty()) return settings;
  auto yaml = YamlSection::fromFile(file);
  readConfig(yaml, settings.estimation);
  auto topics = yaml.section("topics");
  topics.text("fix", settings.fix_topic);
  topics.text("imu", settings.imu_topic);
  topics.text("twist", settings.twist_topic);
  topics.finish();
  auto frames = yaml.section("frames");
  frames.text("map", settings.map_frame);
  frames.text("odom", settings.odom_frame);
  frames.text("base", settings.base_frame);
  frames.number("timeout", settings.frame_timeout, {0, 3600});
  frames.finish();
  if (yaml.has("datum")) {
    std::vector<double> datum;
    yaml.numbers("datum", datum, 3);
    if (std::abs(datum[0]) > 90) yaml.fail("datum", "has a latitude beyond 90 degrees");
    settings.datum = Geodetic{datum[0], datum[1], datum[2]};
  }
  yaml.finish();
  return settings;
}

}  // namespace sas_motion::ros_side
