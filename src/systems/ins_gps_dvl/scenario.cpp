// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

namespace sas_motion::ins {
namespace {

void readWave(YamlSection yaml, Wave& wave, bool angle) {
  if (angle)
    yaml.angle("amplitude_deg", wave.amplitude, {0, 45});
  else
    yaml.number("amplitude", wave.amplitude, {0, 20});
  yaml.number("period", wave.period, {0.5, 1e3});
  yaml.number("phase", wave.phase, {-10, 10});
  yaml.finish();
}

void readLines(YamlSection yaml, Track& track) {
  yaml.number("speed", track.speed, {0.01, 50});
  yaml.angle("heading_deg", track.heading, {-360, 360});
  yaml.number("line_length", track.line_length, {1, 1e6});
  yaml.angle("turn_rate_deg", track.turn_rate, {0.01, 90});
  yaml.boolean("along_bow", track.along_bow);
  yaml.finish();
}

void readWaves(YamlSection yaml, Track& track) {
  readWave(yaml.section("pitch"), track.pitch, true);
  readWave(yaml.section("roll"), track.roll, true);
  readWave(yaml.section("yaw"), track.yaw, true);
  readWave(yaml.section("heave"), track.heave, false);
  readWave(yaml.section("sway"), track.sway, false);
  yaml.finish();
}

void readSensor(YamlSection& yaml, Scenario::Readings& readings, Vector<3>& lever, double least_rate = 0.001) {
  yaml.number("rate", readings.rate, {least_rate, 1e3});
  readings.noise = Scenario::readNoise(yaml, "noise");
  readings.outages = Scenario::readOutages(yaml, "outages");
  readVector<3>(yaml, "lever_arm", lever, -1e3);
  yaml.finish();
}

}  // namespace

Vector<3> Scenario::Dpc::sightBody() const {
  return {(starboard ? 1 : -1) * std::cos(depression), 0, -std::sin(depression)};
}

void Scenario::readDpc(YamlSection yaml) {
  yaml.number("white_along", dpc.white_along, {kTiny, 10});
  yaml.number("white_sight", dpc.white_sight, {kTiny, 10});
  yaml.angle("depression_deg", dpc.depression, {0, 90});
  std::string side = dpc.starboard ? "starboard" : "port";
  yaml.text("side", side);
  if (side != "starboard" && side != "port")
    yaml.fail("side", fmt::format("is '{}' but must be starboard or port", side));
  dpc.starboard = side == "starboard";
  readSensor(yaml, sensor(Sensor::Dpc), parameters.dpc_lever_body, 0);
}

void readTrack(YamlSection& yaml, Track& track) {
  readGeodetic(yaml, "start", track.start, 85);
  readLines(yaml.section("track"), track);
  readWaves(yaml.section("waves"), track);
}

NoiseMix Scenario::readNoise(YamlSection& owner, const std::string& key) {
  NoiseMix mix = NoiseMix::read(owner, key);
  for (const auto& law : mix.laws)
    if (law.kind == NoiseLaw::Kind::Quantised) owner.fail(key, "names quantised, which these sensors do not simulate");
  return mix;
}

std::vector<Outage> Scenario::readOutages(YamlSection& owner, const std::string& key) {
  std::vector<Outage> outages;
  for (auto& item : owner.list(key)) {
    Outage outage;
    item.number("begin", outage.begin, {0, 1e7});
    item.number("end", outage.end, {0, 1e7});
    if (!(outage.begin < outage.end))
      item.fail("end", fmt::format("is {} but must be after begin, which is {}", outage.end, outage.begin));
    item.finish();
    outages.push_back(outage);
  }
  return outages;
}

Scenario Scenario::fromFile(const std::string& file) { return read(YamlSection::fromFile(file)); }

Scenario Scenario::read(YamlSection yaml) {
  Scenario scenario;
  Parameters& p = scenario.parameters;
  scenario.name = yaml.file();
  readSystem(yaml, "ins_gps_dvl");
  yaml.text("name", scenario.name);
  yaml.number("duration", scenario.duration, {1, 1e6});
  readTrack(yaml, scenario.track);
  auto imu = yaml.section("imu");
  readImuErrors(imu, p, scenario.imu_rate);
  imu.finish();
  auto gps = yaml.section("gps");
  readGpsErrors(gps, p);
  readSensor(gps, scenario.sensor(Sensor::Gps), p.gps_lever_body);
  auto dvl = yaml.section("dvl");
  readDvlErrors(dvl, p);
  readSensor(dvl, scenario.sensor(Sensor::Dvl), p.dvl_lever_body);
  p.dvl_rate = scenario.sensor(Sensor::Dvl).rate;
  auto depth = yaml.section("depth");
  readDepthErrors(depth, p);
  readSensor(depth, scenario.sensor(Sensor::Depth), p.depth_lever_body);
  scenario.readDpc(yaml.section("dpc"));
  auto begin = yaml.section("initial");
  readVector<3>(begin, "position", p.start_position, kTiny);
  begin.number("velocity", p.start_velocity, {kTiny, 100});
  begin.angle("tilt_deg", p.start_tilt, {kTiny, 10});
  begin.angle("heading_deg", p.start_heading, {kTiny, 10});
  begin.finish();
  yaml.finish();
  return scenario;
}

}  // namespace sas_motion::ins
