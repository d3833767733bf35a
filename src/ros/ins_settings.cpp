// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/ros/ins_settings.hpp"

namespace sas_motion::ros_side {

InsSettings InsSettings::fromFile(const std::string& file) {
  InsSettings settings;
  if (file.empty()) return settings;
  auto yaml = YamlSection::fromFile(file);
  ins::readSettings(yaml, settings.estimation);
  auto topics = yaml.section("topics");
  topics.text("fix", settings.fix_topic);
  topics.text("imu", settings.imu_topic);
  topics.text("twist", settings.twist_topic);
  topics.text("depth", settings.depth_topic);
  topics.finish();
  settings.readMap(yaml);
  yaml.finish();
  return settings;
}

}  // namespace sas_motion::ros_side
