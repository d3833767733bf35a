// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/config.hpp"

#include "sas_motion/config/yaml_vector.hpp"

namespace sas_motion::sins {
namespace {

constexpr double kLargestStart = 90;  // initial misalignment [deg]

void readImu(YamlSection yaml, Settings& settings) {
  Mechanisation::Options& imu = settings.config.imu;
  double rate = 1 / imu.period;
  readImuErrors(yaml, settings.config.parameters, rate);
  imu.period = 1 / rate;
  ins::readUnit(yaml, imu, settings.shared);
  yaml.finish();
}

void readGps(YamlSection yaml, ins::Settings& shared) {
  readVector<3>(yaml, "white", shared.of(ins::Sensor::Gps).white, kTiny);
  ins::readMessages(yaml, shared.of(ins::Sensor::Gps));
}

void readDvl(YamlSection yaml, Settings& settings) {
  readDvlErrors(yaml, settings.config.parameters);
  yaml.number("lever_sigma", settings.config.parameters.dvl_lever_sigma, {0, 10});
  ins::MessageOptions& messages = settings.shared.of(ins::Sensor::Dvl);
  messages.white = settings.config.parameters.dvl_white;
  ins::readMessages(yaml, messages);
}

void readDepth(YamlSection yaml, Settings& settings) {
  double& white = settings.config.parameters.depth_white;
  yaml.number("white", white, {kTiny, 1e3});
  yaml.number("surface", settings.shared.surface, {-1e4, 1e4});
  ins::MessageOptions& messages = settings.shared.of(ins::Sensor::Depth);
  messages.white.setConstant(white);
  ins::readMessages(yaml, messages);
}

void readParticles(YamlSection yaml, UnscentedParticleOptions& particles) {
  yaml.integer("number", particles.particles, 1, 1'000'000);
  yaml.integer("threads", particles.threads, 1, 1024);
  int seed = static_cast<int>(particles.seed);
  yaml.integer("seed", seed, 0, 2'000'000'000);
  particles.seed = static_cast<std::uint64_t>(seed);
  yaml.number("resample_below", particles.resample_below, {0, 1});
  yaml.finish();
}

}  // namespace

/// A fix only starts this system, and its attitude may be far off.
Settings::Settings() {
  shared.session.alignment.fixes_aid = false;
  shared.of(ins::Sensor::Dvl).white = config.parameters.dvl_white;
  config.imu = shared.session.config.imu;
}

void readImuErrors(YamlSection& yaml, Parameters& p, double& rate) {
  yaml.number("rate", rate, {10, 1e4});
  readScaled(yaml, "gyro_constant_deg_h", p.gyro_constant, kDegPerHour, {kTiny, 1e3});
  readScaled(yaml, "angle_random_walk_deg_sqrt_h", p.angle_random_walk, kRadPerDeg / 60, {kTiny, 10});
  readScaled(yaml, "accelerometer_constant_ug", p.accelerometer_constant, kMicroG, {kTiny, 1e5});
  readScaled(yaml, "velocity_random_walk_ug_sqrt_s", p.velocity_random_walk, kMicroG, {kTiny, 1e5});
}

void readDvlErrors(YamlSection& yaml, Parameters& p) {
  yaml.number("offset", p.dvl_offset, {kTiny, 10});
  yaml.number("offset_time", p.dvl_offset_time, {1, 1e7});
  readScaled(yaml, "scale_percent", p.dvl_scale, 0.01, {kTiny, 50});
  yaml.angle("angle_deg", p.dvl_angle, {kTiny, 45});
  yaml.number("angle_time", p.dvl_angle_time, {1, 1e7});
  readVector<3>(yaml, "white", p.dvl_white, kTiny);
}

void readSettings(YamlSection& yaml, Settings& settings) {
  readSystem(yaml, "sins_dvl");
  readImu(yaml.section("imu"), settings);
  readGps(yaml.section("gps"), settings.shared);
  readDvl(yaml.section("dvl"), settings);
  readDepth(yaml.section("depth"), settings);
  readParticles(yaml.section("particles"), settings.config.particles);
  yaml.boolean("accelerometer_bias", settings.config.accelerometer_bias);
  auto start = yaml.section("start");
  ins::readStart(start, settings.shared.session, kLargestStart);
  start.finish();
  ins::readSession(yaml, settings.shared);
  settings.shared.session.config.imu = settings.config.imu;
}

}  // namespace sas_motion::sins
