// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kLargestStart = 10;  // initial misalignment that is small [deg]

void readImu(YamlSection yaml, Settings& settings) {
  Config& config = settings.session.config;
  double rate = 1 / config.imu.period;
  readImuErrors(yaml, config.parameters, rate);
  config.imu.period = 1 / rate;
  readUnit(yaml, config.imu, settings);
  yaml.finish();
}

void readAlignment(YamlSection yaml, SessionOptions& session) {
  yaml.number("position_sigma", session.alignment.position_sigma, {kTiny, 1e5});
  readStart(yaml, session, kLargestStart);
  yaml.finish();
}

/// A message without a covariance has the white noise of the filters.
void shareWhite(Settings& settings) {
  const Parameters& p = settings.session.config.parameters;
  settings.of(Sensor::Gps).white = p.gps_white;
  settings.of(Sensor::Dvl).white = p.dvl_white;
  settings.of(Sensor::Depth).white.setConstant(p.depth_white);
}

}  // namespace

/// Messages state how well an attitude is known; where one does not, it is taken to be that of a cheap unit.
Settings::Settings() {
  session.config.parameters.start_tilt = 0.5 * kRadPerDeg;
  session.config.parameters.start_heading = 5 * kRadPerDeg;
  session.config.imu.max_rate = 1000 * kRadPerDeg;
  of(Sensor::Gps).floor = of(Sensor::Depth).floor = 0.01;
  of(Sensor::Dvl).floor = 0.001;
  shareWhite(*this);
}

void readMessages(YamlSection& yaml, MessageOptions& options) {
  yaml.number("floor", options.floor, {0, 1e4});
  yaml.boolean("override_message", options.override_message);
  yaml.number("time_offset", options.time_offset, {-3600, 3600});
  yaml.boolean("enabled", options.enabled);
  yaml.finish();
}

void readUnit(YamlSection& yaml, Mechanisation::Options& imu, Settings& settings) {
  yaml.number("longest_gap", imu.longest_gap, {kTiny, 10});
  yaml.angle("max_rate_deg", imu.max_rate, {1, 1e5});
  yaml.number("max_force", imu.max_force, {10, 1e5});
  yaml.number("time_offset", settings.imu_time_offset, {-3600, 3600});
}

void readStart(YamlSection& yaml, SessionOptions& session, double largest_deg) {
  AlignmentOptions& alignment = session.alignment;
  yaml.number("max_age", alignment.max_age, {kTiny, 60});
  yaml.number("velocity_wait", alignment.velocity_wait, {0, 1e6});
  yaml.number("velocity_sigma", alignment.velocity_sigma, {kTiny, 100});
  yaml.number("rest_velocity_sigma", alignment.rest_velocity_sigma, {kTiny, 100});
  yaml.number("gnss_velocity_sigma", alignment.ground_velocity_sigma, {kTiny, 100});
  yaml.angle("tilt_deg", session.config.parameters.start_tilt, {kTiny, largest_deg});
  yaml.angle("heading_deg", session.config.parameters.start_heading, {kTiny, largest_deg});
}

void readSession(YamlSection& yaml, Settings& settings) {
  yaml.number("lag", settings.session.lag, {0, 3600});
  yaml.number("max_gap", settings.session.max_gap, {kTiny, 1e6});
  yaml.number("output_rate", settings.output_rate, {0.001, 1e4});
  auto estimators = yaml.section("estimators");
  readOptions(estimators, settings.session.config.filters);
  estimators.finish();
}

void readImuErrors(YamlSection& yaml, Parameters& p, double& rate) {
  yaml.number("rate", rate, {10, 1e4});
  readScaled(yaml, "gyro_constant_deg_h", p.gyro_constant, kDegPerHour, {kTiny, 1e3});
  readScaled(yaml, "gyro_markov_deg_h", p.gyro_markov, kDegPerHour, {kTiny, 1e3});
  yaml.number("gyro_time", p.gyro_time, {1, 1e7});
  readScaled(yaml, "angle_random_walk_deg_sqrt_h", p.angle_random_walk, kRadPerDeg / 60, {0, 10});
  readScaled(yaml, "accelerometer_constant_ug", p.accelerometer_constant, kMicroG, {kTiny, 1e5});
  readScaled(yaml, "velocity_random_walk_ug_sqrt_s", p.velocity_random_walk, kMicroG, {0, 1e5});
}

void readGpsErrors(YamlSection& yaml, Parameters& p) {
  readVector<3>(yaml, "markov", p.gps_markov, kTiny);
  yaml.number("time", p.gps_time, {1, 1e7});
  readVector<3>(yaml, "white", p.gps_white, kTiny);
}

void readDvlErrors(YamlSection& yaml, Parameters& p) {
  yaml.number("markov", p.dvl_markov, {kTiny, 10});
  yaml.number("time", p.dvl_time, {1, 1e7});
  double white = p.dvl_white.x();
  yaml.number("white", white, {kTiny, 10});
  p.dvl_white.setConstant(white);
  readScaled(yaml, "scale_percent", p.dvl_scale, 0.01, {0, 20});
  yaml.angle("misalignment_deg", p.dvl_misalignment, {0, 10});
  yaml.number("lever_sigma", p.dvl_lever_sigma, {0, 10});
}

void readDepthErrors(YamlSection& yaml, Parameters& p) { yaml.number("white", p.depth_white, {kTiny, 1e3}); }

void readSettings(YamlSection& yaml, Settings& settings) {
  Parameters& p = settings.session.config.parameters;
  readSystem(yaml, "ins_gps_dvl");
  readImu(yaml.section("imu"), settings);
  auto gps = yaml.section("gps");
  readGpsErrors(gps, p);
  readMessages(gps, settings.of(Sensor::Gps));
  auto dvl = yaml.section("dvl");
  dvl.number("rate", p.dvl_rate, {0.001, 1e3});
  readDvlErrors(dvl, p);
  readMessages(dvl, settings.of(Sensor::Dvl));
  auto depth = yaml.section("depth");
  readDepthErrors(depth, p);
  depth.number("surface", settings.surface, {-1e4, 1e4});
  readMessages(depth, settings.of(Sensor::Depth));
  readAlignment(yaml.section("start"), settings.session);
  readSession(yaml, settings);
  shareWhite(settings);
}

}  // namespace sas_motion::ins
