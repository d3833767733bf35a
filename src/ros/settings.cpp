// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/settings.hpp"

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion::ros_side {

void MapSettings::readMap(YamlSection& yaml) {
  auto frames = yaml.section("frames");
  frames.text("map", map_frame);
  frames.text("odom", odom_frame);
  frames.text("base", base_frame);
  frames.number("timeout", frame_timeout, {0, 3600});
  frames.finish();
  if (!yaml.has("datum")) return;
  datum.emplace();
  readGeodetic(yaml, "datum", *datum);
}

}  // namespace sas_motion::ros_side
