// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/scenario.hpp"

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/systems/sins_dvl/config.hpp"

namespace sas_motion::sins {
namespace {

void readReadings(YamlSection& yaml, ins::Scenario::Readings& readings, Vector<3>& lever_body) {
  yaml.number("rate", readings.rate, {0.001, 1e3});
  readVector<3>(yaml, "lever_arm", lever_body, -1e3);
  readings.noise = ins::Scenario::readNoise(yaml, "noise");
  readings.outages = ins::Scenario::readOutages(yaml, "outages");
  yaml.finish();
}

void readStart(YamlSection yaml, Scenario& scenario) {
  Parameters& p = scenario.parameters;
  readVector<3>(yaml, "position", p.start_position, kTiny);
  yaml.number("velocity", p.start_velocity, {kTiny, 100});
  yaml.angle("tilt_deg", p.start_tilt, {kTiny, 45});
  yaml.angle("heading_deg", p.start_heading, {kTiny, 90});
  yaml.boolean("misaligned_by_sigma", scenario.misaligned_by_sigma);
  yaml.finish();
}

}  // namespace

Scenario Scenario::fromFile(const std::string& file) { return read(YamlSection::fromFile(file)); }

Scenario Scenario::read(YamlSection yaml) {
  Scenario scenario;
  scenario.name = yaml.file();
  readSystem(yaml, "sins_dvl");
  yaml.text("name", scenario.name);
  yaml.number("duration", scenario.duration, {1, 1e6});
  ins::readTrack(yaml, scenario.track);
  Parameters& p = scenario.parameters;
  auto imu = yaml.section("imu");
  readImuErrors(imu, p, scenario.imu_rate);
  imu.finish();
  auto dvl = yaml.section("dvl");
  readDvlErrors(dvl, p);
  readReadings(dvl, scenario.dvl, p.dvl_lever_body);
  auto depth = yaml.section("depth");
  depth.number("white", p.depth_white, {kTiny, 1e3});
  readReadings(depth, scenario.depth, p.depth_lever_body);
  readStart(yaml.section("initial"), scenario);
  yaml.finish();
  return scenario;
}

}  // namespace sas_motion::sins
