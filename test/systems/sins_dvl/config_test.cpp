// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/config.hpp"

#include "support.hpp"

namespace sas_motion::sins {
namespace {

Settings read(YamlSection yaml) {
  Settings settings;
  readSettings(yaml, settings);
  for (const char* key : {"topics", "frames"}) yaml.ignore(key);
  yaml.finish();
  return settings;
}

Settings readText(const std::string& text) { return read(YamlSection::fromText(text, "test.yaml")); }
std::string errorOf(const std::string& text) {
  return testing::configErrorOf([&] { readText(text); });
}

std::vector<double> numbersOf(const Settings& s) {
  const Parameters& p = s.config.parameters;
  const auto& imu = s.config.imu;
  const auto& alignment = s.shared.session.alignment;
  const auto& found = s.shared.session.config;
  std::vector<double> all{p.gyro_constant,
                          p.angle_random_walk,
                          p.accelerometer_constant,
                          p.velocity_random_walk,
                          p.dvl_offset,
                          p.dvl_offset_time,
                          p.dvl_scale,
                          p.dvl_angle,
                          p.dvl_angle_time,
                          p.depth_white,
                          p.dvl_lever_sigma,
                          imu.period,
                          imu.longest_gap,
                          imu.max_rate,
                          imu.max_force,
                          alignment.max_age,
                          alignment.velocity_wait,
                          alignment.velocity_sigma,
                          alignment.rest_velocity_sigma,
                          alignment.ground_velocity_sigma,
                          found.parameters.start_tilt,
                          found.parameters.start_heading,
                          found.imu.period,
                          s.shared.session.lag,
                          s.shared.session.max_gap,
                          s.shared.output_rate,
                          s.shared.surface,
                          s.shared.imu_time_offset,
                          s.config.particles.resample_below,
                          s.config.longest_step};
  all.insert(all.end(), {double(s.config.particles.particles), double(s.config.particles.threads),
                         double(s.config.particles.seed)});
  all.push_back(s.config.accelerometer_bias ? 1 : 0);
  for (int axis = 0; axis < 3; ++axis) {
    all.push_back(p.dvl_white(axis));
    for (const auto& messages : s.shared.messages) all.push_back(messages.white(axis));
  }
  for (const auto& m : s.shared.messages)
    all.insert(all.end(), {m.floor, m.time_offset, m.override_message ? 1.0 : 0.0, m.enabled ? 1.0 : 0.0});
  return all;
}

TEST(SinsConfig, TheFileHoldsTheDefaults) {
  const auto file = numbersOf(read(YamlSection::fromFile(SAS_MOTION_SOURCE_DIR "/config/sins_dvl.yaml"))),
             built_in = numbersOf(Settings());
  for (std::size_t i = 0; i < file.size(); ++i) EXPECT_NEAR(file[i], built_in[i], 1e-12 * std::abs(built_in[i])) << i;
}

TEST(SinsConfig, KeysReachTheirMembersInSiUnits) {
  const Settings s = readText(
      "{system: sins_dvl, imu: {rate: 200, gyro_constant_deg_h: 3}, dvl: {scale_percent: 1, angle_deg: 2, white: [1, "
      "2, 3], floor: 0.5}, depth: {white: 0.3}, "
      "particles: {number: 50, threads: 2, seed: 9}, accelerometer_bias: false, start: {heading_deg: 30}, lag: 1}");
  EXPECT_DOUBLE_EQ(s.config.imu.period, 0.005);
  EXPECT_DOUBLE_EQ(s.shared.session.config.imu.period, 0.005);
  EXPECT_NEAR(s.config.parameters.gyro_constant, 3 * kRadPerDeg / 3600, 1e-18);
  EXPECT_NEAR(s.config.parameters.dvl_scale, 0.01, 1e-15);
  EXPECT_NEAR(s.config.parameters.dvl_angle, 2 * kRadPerDeg, 1e-15);
  EXPECT_EQ(s.shared.of(ins::Sensor::Dvl).white, Vector<3>(1, 2, 3));
  EXPECT_EQ(s.shared.of(ins::Sensor::Dvl).floor, 0.5);
  EXPECT_EQ(s.shared.of(ins::Sensor::Depth).white, Vector<3>(0.3, 0.3, 0.3));
  EXPECT_EQ(s.config.particles.particles, 50);
  EXPECT_EQ(s.config.particles.threads, 2);
  EXPECT_EQ(s.config.particles.seed, 9u);
  EXPECT_FALSE(s.config.accelerometer_bias);
  EXPECT_NEAR(s.shared.session.config.parameters.start_heading, 30 * kRadPerDeg, 1e-15);
  EXPECT_EQ(s.shared.session.lag, 1);
}

TEST(SinsConfig, ErrorsNameKeyValueAndBound) {
  EXPECT_NE(errorOf("{particles: {number: 0}}").find("particles.number is 0 but must lie between 1 and"),
            std::string::npos);
  EXPECT_NE(errorOf("{start: {heading_deg: 120}}").find("start.heading_deg is 120 but must be"), std::string::npos);
  EXPECT_NE(errorOf("{start: {position_sigma: 30}}").find("start.position_sigma is no known key"),
            std::string::npos);  // the fix is not fused
  EXPECT_NE(errorOf("{system: ins_gps_dvl}").find("system is 'ins_gps_dvl' but must be sins_dvl"), std::string::npos);
}

}  // namespace
}  // namespace sas_motion::sins
