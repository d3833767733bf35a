// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/scenario.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/systems/towfish/config.hpp"

namespace sas_motion::towfish {
namespace {

void requireMultiple(const YamlSection& yaml, const std::string& key, double seconds, double step) {
  const double steps = seconds / step;
  if (std::abs(steps - std::round(steps)) > 1e-6)
    yaml.fail(key, fmt::format("gives {} s, which is no multiple of step, {} s", seconds, step));
}

void readSensor(YamlSection yaml, double step, SimulatedSource& options) {
  const bool angular = options.sensor == Sensor::Heading || options.sensor == Sensor::TurnRate;
  yaml.number("rate", options.rate, {0, 1e4});
  yaml.number("phase", options.phase, {0, 3600});
  if (angular)
    yaml.angle("sigma_deg", options.sigma, {kTiny, 180});
  else
    yaml.number("sigma", options.sigma, {kTiny, 1e4});
  options.noise = NoiseMix::read(yaml, "noise");
  if (options.rate > 0) requireMultiple(yaml, "rate", 1 / options.rate, step);
  requireMultiple(yaml, "phase", options.phase, step);
  yaml.number("time_offset", options.time_offset, {-3600, 3600});
  if (options.sensor == Sensor::Position) readVector<2>(yaml, "lever_arm_body", options.lever_arm_body);
  yaml.finish();
}

/// The default source of a sensor, and the last part of the default topic of others.
struct Defaults {
  const char *topic, *frame, *leaf;
  double sigma;
};
constexpr std::array<Defaults, kSensors> kDefaults{{{"gnss/fix", "gnss_link", "fix", 1},
                                                    {"imu/data", "imu_link", "imu", 0.5 * kRadPerDeg},
                                                    {"dvl/twist", "dvl_link", "twist", 1},
                                                    {"imu/data", "imu_link", "imu", 0.1 * kRadPerDeg},
                                                    {"dvl/velocity", "dvl_link", "velocity", 1}}};  // by Sensor

const Defaults& defaultsOf(Sensor sensor) { return kDefaults[static_cast<std::size_t>(sensor)]; }

/// Further sources, each with a name of its own.
void readSources(YamlSection& yaml, Scenario& scenario) {
  for (auto& item : yaml.list("sources")) {
    SimulatedSource source;
    std::string measures;
    item.text("name", source.name);
    item.text("measures", measures);
    const auto sensor = sensorFromName(measures);
    if (!sensor)
      item.fail("measures",
                fmt::format("is '{}' but must be position, heading, speed, turn_rate or velocity", measures));
    source.sensor = *sensor;
    source.sigma = defaultsOf(*sensor).sigma;
    source.topic = fmt::format("{}/{}", source.name, defaultsOf(*sensor).leaf);
    source.frame = source.name + "_link";
    item.text("topic", source.topic);
    for (const auto& other : scenario.sources)
      if (source.name.empty() || source.name == other.name ||
          (other.name.empty() && source.name == sensorName(other.sensor)))
        item.fail("name", fmt::format("is '{}' but each source needs a name of its own", source.name));
    readSensor(item, scenario.step, source);
    if (static_cast<int>(scenario.sources.size()) == kMaxSources)
      yaml.fail("sources", fmt::format("has more than {} sources beside the default ones", kMaxSources - kSensors));
    scenario.sources.push_back(source);
  }
}

void readTruth(YamlSection yaml, Scenario& scenario) {
  std::string kind = "random_walk";
  yaml.text("kind", kind);
  if (kind != "random_walk" && kind != "survey")
    yaml.fail("kind", fmt::format("is '{}' but must be random_walk or survey", kind));
  scenario.kind = kind == "survey" ? Scenario::Kind::Survey : Scenario::Kind::RandomWalk;
  yaml.angle("heading_deg", scenario.heading, {-360, 360});
  yaml.number("speed", scenario.speed, {0, 50});
  readVector<2>(yaml, "current", scenario.current);
  readMotionParameters(yaml.section("motion"), scenario.motion);
  scenario.process = NoiseMix::read(yaml, "process", NoiseUse::Process);
  auto front = yaml.section("front");
  front.number("time", scenario.front.time, {0, 1e7});
  front.number("width", scenario.front.width, {kTiny, 1e6});
  readVector<2>(front, "change", scenario.front.change);
  front.finish();
  yaml.number("line_length", scenario.line_length, {kTiny, 1e6});
  yaml.angle("turn_rate_deg", scenario.turn_rate, {kTiny, 90});
  yaml.angle("yaw_sigma_deg", scenario.yaw_sigma, {0, 45});
  yaml.number("yaw_period", scenario.yaw_period, {0.1, 1e4});
  yaml.number("surge_sigma", scenario.surge_sigma, {0, 10});
  yaml.finish();
}

}  // namespace

Scenario::Scenario() {
  for (int i = 0; i < kSensors; ++i) {
    SimulatedSource& source = sources.emplace_back();
    source.sensor = static_cast<Sensor>(i);
    source.topic = defaultsOf(source.sensor).topic;
    source.frame = defaultsOf(source.sensor).frame;
  }
}

Scenario Scenario::read(YamlSection yaml) {
  Scenario scenario;
  scenario.name = yaml.file();
  yaml.text("name", scenario.name);
  yaml.number("duration", scenario.duration, {kTiny, 1e7});
  yaml.number("step", scenario.step, {1e-4, 10});
  readGeodetic(yaml, "datum", scenario.datum);
  readTruth(yaml.section("truth"), scenario);
  auto sensors = yaml.section("sensors");
  for (auto& sensor : scenario.sources) {
    sensor.sigma = defaultsOf(sensor.sensor).sigma;
    readSensor(sensors.section(sensorName(sensor.sensor)), scenario.step, sensor);
  }
  sensors.finish();
  readVector<2>(yaml, "gnss_lever_arm_body", scenario.source(Sensor::Position).lever_arm_body);
  readSources(yaml, scenario);
  yaml.finish();
  return scenario;
}

}  // namespace sas_motion::towfish
