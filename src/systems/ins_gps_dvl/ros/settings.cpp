// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/settings.hpp"

#include "sas_motion/systems/sins_dvl/config.hpp"
#include "systems/ins_gps_dvl/graph/smoother.hpp"
#include "systems/sins_dvl/graph/estimators.hpp"

namespace sas_motion::ros_side {

InsSettings::InsSettings() : make(ins::makeAnyEstimator), estimators(ins::anyEstimatorNames()) {}

InsSettings InsSettings::fromFile(const std::string& file) {
  InsSettings settings;
  if (file.empty()) return settings;
  auto yaml = YamlSection::fromFile(file);
  settings.readEstimation(yaml);
  auto topics = yaml.section("topics");
  topics.text("fix", settings.fix_topic);
  topics.text("imu", settings.imu_topic);
  topics.text("twist", settings.twist_topic);
  topics.text("depth", settings.depth_topic);
  topics.text("velocity", settings.velocity_topic);
  topics.finish();
  settings.readMap(yaml);
  yaml.finish();
  return settings;
}

void InsSettings::readEstimation(YamlSection& yaml) {
  std::string system = "ins_gps_dvl";
  yaml.text("system", system);
  if (system != "sins_dvl") return ins::readSettings(yaml, estimation);
  sins::Settings settings;
  sins::readSettings(yaml, settings);
  estimation = settings.shared;
  make = [config = settings.config](const std::string& name, const ins::Config& found) {
    return sins::makeAnyEstimator(name, startedAt(config, found.parameters));
  };
  estimators = sins::anyEstimatorNames();
  preferred = "ss_srupf";
  velocity_topic = "gnss/velocity";
}

}  // namespace sas_motion::ros_side
