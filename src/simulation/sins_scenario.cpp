// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/simulation/sins_scenario.hpp"

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion::sins {
namespace {

void readImu(YamlSection yaml, Scenario& scenario) {
  Parameters& p = scenario.parameters;
  yaml.number("rate", scenario.imu_rate, {10, 1e4});
  readScaled(yaml, "gyro_constant_deg_h", p.gyro_constant, kDegPerHour, {kTiny, 1e3});
  readScaled(yaml, "angle_random_walk_deg_sqrt_h", p.angle_random_walk, kRadPerDeg / 60, {kTiny, 10});
  readScaled(yaml, "accelerometer_constant_ug", p.accelerometer_constant, kMicroG, {kTiny, 1e5});
  readScaled(yaml, "velocity_random_walk_ug_sqrt_s", p.velocity_random_walk, kMicroG, {kTiny, 1e5});
  yaml.finish();
}

void readReadings(YamlSection& yaml, ins::Scenario::Readings& readings) {
  yaml.number("rate", readings.rate, {0.001, 1e3});
  readings.noise = ins::Scenario::readNoise(yaml, "noise");
  readings.outages = ins::Scenario::readOutages(yaml, "outages");
  yaml.finish();
}

void readDvl(YamlSection yaml, Scenario& scenario) {
  Parameters& p = scenario.parameters;
  yaml.number("offset", p.dvl_offset, {kTiny, 10});
  yaml.number("offset_time", p.dvl_offset_time, {1, 1e7});
  readScaled(yaml, "scale_percent", p.dvl_scale, 0.01, {kTiny, 50});
  yaml.angle("angle_deg", p.dvl_angle, {kTiny, 45});
  yaml.number("angle_time", p.dvl_angle_time, {1, 1e7});
  readVector<3>(yaml, "white", p.dvl_white, kTiny);
  readReadings(yaml, scenario.dvl);
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
  readImu(yaml.section("imu"), scenario);
  readDvl(yaml.section("dvl"), scenario);
  auto depth = yaml.section("depth");
  depth.number("white", scenario.parameters.depth_white, {kTiny, 1e3});
  readReadings(depth, scenario.depth);
  readStart(yaml.section("initial"), scenario);
  yaml.finish();
  return scenario;
}

}  // namespace sas_motion::sins
