// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

#include "support.hpp"

namespace sas_motion::ins {
namespace {

Settings read(const std::string& text) {
  auto yaml = YamlSection::fromText(text, "test.yaml");
  Settings settings;
  readSettings(yaml, settings);
  yaml.finish();
  return settings;
}

std::string errorOf(const std::string& text) {
  return testing::configErrorOf([&] { read(text); });
}

TEST(InsConfig, TheFileHoldsTheDefaults) {
  auto yaml = YamlSection::fromFile(SAS_MOTION_SOURCE_DIR "/config/ins_gps_dvl.yaml");
  Settings file;
  readSettings(yaml, file);
  for (const char* key : {"topics", "frames"}) yaml.ignore(key);
  yaml.finish();
  const Settings built_in;
  const auto numbers = [](const Settings& s) {
    const Parameters& p = s.session.config.parameters;
    const AlignmentOptions& a = s.session.alignment;
    const auto& imu = s.session.config.imu;
    std::vector<double> all{p.gyro_constant,
                            p.gyro_markov,
                            p.gyro_time,
                            p.angle_random_walk,
                            p.accelerometer_constant,
                            p.velocity_random_walk,
                            p.gps_time,
                            p.dvl_markov,
                            p.dvl_time,
                            p.dvl_white.x(),
                            p.dvl_rate,
                            p.depth_white,
                            p.start_tilt,
                            p.start_heading,
                            imu.period,
                            imu.longest_gap,
                            imu.max_rate,
                            imu.max_force,
                            a.max_age,
                            a.velocity_wait,
                            a.position_sigma,
                            a.velocity_sigma,
                            a.rest_velocity_sigma,
                            a.ground_velocity_sigma,
                            s.session.lag,
                            s.session.max_gap,
                            s.output_rate,
                            s.surface,
                            s.imu_time_offset};
    for (int axis = 0; axis < 3; ++axis) all.insert(all.end(), {p.gps_markov(axis), p.gps_white(axis)});
    for (const auto& m : s.messages)
      all.insert(all.end(), {m.floor, m.time_offset, m.override_message ? 1.0 : 0.0, m.enabled ? 1.0 : 0.0});
    return all;
  };
  const auto a = numbers(file), b = numbers(built_in);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * std::abs(b[i])) << i;
}

TEST(InsConfig, KeysReachTheirMembersInSiUnits) {
  const Settings s = read(
      "{imu: {rate: 200, gyro_constant_deg_h: 3, max_rate_deg: 180, time_offset: 0.01}, gps: {white: [1, 2, 3], floor: "
      "0.2, override_message: true}, "
      "estimators: {gated_kf: {probability: 0.9}}, dvl: {enabled: false, lever_sigma: 0.3}, depth: {surface: 36.5}, "
      "start: {heading_deg: 2, max_age: 3}, lag: 1, "
      "output_rate: 10}");
  const Parameters& p = s.session.config.parameters;
  EXPECT_DOUBLE_EQ(s.session.config.imu.period, 0.005);
  EXPECT_NEAR(p.gyro_constant, 3 * kRadPerDeg / 3600, 1e-18);
  EXPECT_NEAR(s.session.config.imu.max_rate, kPi, 1e-12);
  EXPECT_EQ(p.gps_white, Vector<3>(1, 2, 3));
  EXPECT_TRUE(s.of(Sensor::Gps).override_message);
  EXPECT_FALSE(s.of(Sensor::Dvl).enabled);
  EXPECT_EQ(p.dvl_lever_sigma, 0.3);
  EXPECT_EQ(s.surface, 36.5);
  EXPECT_EQ(s.session.config.filters.gated_kf.probability, 0.9);
  EXPECT_NEAR(p.start_heading, 2 * kRadPerDeg, 1e-15);
  EXPECT_EQ(s.session.lag, 1);
  EXPECT_EQ(s.output_rate, 10);
}

TEST(InsConfig, ErrorsNameKeyValueAndBound) {
  EXPECT_EQ(errorOf("{lag: -1}"), "test.yaml: lag is -1 but must be at least 0 and at most 3600");
  EXPECT_NE(errorOf("{gps: {whyte: 1}}").find("gps.whyte is no known key"), std::string::npos);
  EXPECT_NE(errorOf("{imu: {rate: 1}}").find("imu.rate is 1 but must be at least 10"), std::string::npos);
  EXPECT_NE(errorOf("{dvl: {lever_arm: [0, 0, 0]}}").find("dvl.lever_arm is no known key"),
            std::string::npos);  // that is tf's
  EXPECT_NE(errorOf("{system: usbl}").find("system is 'usbl' but must be ins_gps_dvl"), std::string::npos);
}

}  // namespace
}  // namespace sas_motion::ins
