// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/config.hpp"

#include <fmt/format.h>

#include "sas_motion/config/yaml_loss.hpp"

namespace sas_motion::towfish {
namespace {

/// How much a measurement weighs. A turn rate is an input of the motion and has no weight.
void readWeight(YamlSection& yaml, Sensor sensor, SensorOptions& options) {
  if (sensor == Sensor::TurnRate) {
    for (const char* key : {"sigma_deg", "floor_deg", "override_message"})
      if (yaml.has(key))
        yaml.fail(key, "would have no effect; set model.heading_noise_deg, which holds the error of the turn rate");
    return;
  }
  if (sensor == Sensor::Heading) {
    yaml.angle("sigma_deg", options.sigma, {kTiny, 180});
    yaml.angle("floor_deg", options.floor, {0, 180});
  } else {
    yaml.number("sigma", options.sigma, {kTiny, 1e4});
    yaml.number("floor", options.floor, {0, 1e4});
  }
  yaml.boolean("override_message", options.override_message);
}

void readSensor(YamlSection yaml, Sensor sensor, SensorOptions& options) {
  readWeight(yaml, sensor, options);
  yaml.number("time_offset", options.time_offset, {-3600, 3600});
  yaml.boolean("enabled", options.enabled);
  yaml.finish();
}

void readSensors(YamlSection& yaml, Config& config) {
  if (!yaml.has("sources")) {
    auto sensors = yaml.section("sensors");
    for (int i = 0; i < kSensors; ++i) {
      const auto sensor = static_cast<Sensor>(i);
      readSensor(sensors.section(sensorName(sensor)), sensor, config.sensor(sensor));
    }
    return sensors.finish();
  }
  for (const char* key : {"sensors", "topics"})
    if (yaml.has(key)) yaml.fail(key, "and sources are two ways to say the same; leave one out");
  SourceKinds kinds{{}, {sensorName(Sensor::Heading), sensorName(Sensor::TurnRate)}, {}};
  for (int i = 0; i < kSensors; ++i) kinds.all.emplace_back(sensorName(static_cast<Sensor>(i)));
  kinds.required = {sensorName(Sensor::Position), sensorName(Sensor::Heading)};
  config.sources = readSources(yaml, kinds, {config.sensors.begin(), config.sensors.end()});
  const std::vector<std::string> of_imu = kinds.angles;
  for (const auto& source : config.sources)
    if (source.measures.size() > 1 && source.measures != of_imu)
      yaml.fail("sources", fmt::format("has {}, which measures {}; only heading and turn_rate come in one message",
                                       source.name, fmt::join(source.measures, " and ")));
  if (config.sources.size() > kMaxSources)
    yaml.fail("sources", fmt::format("has {} sources but may have {}", config.sources.size(), kMaxSources));
}

void readSmoother(YamlSection yaml, SmootherOptions& options) {
  readLoss(yaml, options.loss);
  yaml.integer("max_iterations", options.max_iterations, 1, 10000);
  yaml.number("tolerance", options.tolerance, {0, 1});
  yaml.finish();
}

void readEstimators(YamlSection yaml, Config& config) {
  readOptions(yaml, config.filters);
  readSmoother(yaml.section("rts"), config.rts);
  readSmoother(yaml.section("batch"), config.batch);
  auto gnc = yaml.section("gnc");
  gnc.number("probability", config.gnc_probability, {0.5, 0.999999});
  gnc.finish();
  auto fixed_lag = yaml.section("fixed_lag");
  readLoss(fixed_lag, config.fixed_lag.loss);
  fixed_lag.number("lag", config.fixed_lag.lag, {0.1, 3600});
  fixed_lag.number("solve_interval", config.fixed_lag.solve_interval, {0, 60});
  fixed_lag.number("reorder", config.fixed_lag.reorder, {0, 60});
  fixed_lag.finish();
  yaml.finish();
}

}  // namespace

Config::Config() {
  sensor(Sensor::Position) = {1.0, 0.01, false, 0, true};
  sensor(Sensor::Heading) = {0.5 * kRadPerDeg, 0.01 * kRadPerDeg, false, 0, true};
  sensor(Sensor::Speed) = {0.05, 0.001, false, 0, true};
  sensor(Sensor::TurnRate) = {0.1 * kRadPerDeg, 0, false, 0, true};
  sensor(Sensor::Velocity) = {0.02, 0.001, false, 0, true};
}

void readMotionParameters(YamlSection yaml, MotionParameters& p) {
  yaml.number("current_sigma", p.current_sigma, {kTiny, 100});
  yaml.number("current_time_constant", p.current_time_constant, {kTiny, 1e7});
  yaml.angle("heading_noise_deg", p.heading_noise, {kTiny, 180});
  yaml.number("speed_noise", p.speed_noise, {kTiny, 100});
  yaml.number("position_noise", p.position_noise, {kTiny, 100});
  yaml.finish();
}

void readConfig(YamlSection& yaml, Config& config) {
  readMotionParameters(yaml.section("model"), config.model);
  readSensors(yaml, config);
  auto start = yaml.section("start");
  start.number("window", config.start.window, {0, 3600});
  start.number("position_sigma", config.start.position_sigma, {kTiny, 1e6});
  start.angle("heading_sigma_deg", config.start.heading_sigma, {kTiny, 180});
  start.number("speed_sigma", config.start.speed_sigma, {kTiny, 100});
  start.finish();
  yaml.number("lag", config.lag, {0, 3600});
  yaml.number("reset_after", config.filters.reset_after, {kTiny, 1e6});
  yaml.number("max_gap", config.max_gap, {kTiny, 1e6});
  yaml.number("input_hold", config.input_hold, {0, 3600});
  yaml.angle("turn_rate_limit_deg", config.turn_rate_limit, {kTiny, 3600});
  if (config.start.window > config.lag)
    yaml.fail("start.window",
              fmt::format("is {} but must be at most lag, which is {}", config.start.window, config.lag));
  readEstimators(yaml.section("estimators"), config);
}

}  // namespace sas_motion::towfish
