// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/suites.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::overBound;
using testing::rmse;
using testing::runAll;
using testing::suiteOf;

std::string insSuite(double duration, int runs, const std::string& estimators, const std::string& laws) {
  return "{runs: " + std::to_string(runs) +
         ", campaigns: [{name: ins, system: ins_gps_dvl, scenario: " SAS_MOTION_SOURCE_DIR
         "/config/scenarios/ins/survey.yaml, duration: " +
         std::to_string(duration) + ", skip: 60, estimators: " + estimators + ", laws: " + laws + "}]}";
}

TEST(InsSystem, FusionBeatsItsSensorsAndTheRobustFormOutliers) {
  const auto suite = suiteOf(insSuite(300, 4, "[gnss_alone, dvl, kf27, robust_kf27]",
                                      "[{name: clean}, {name: bad, noise: {law: contaminated, epsilon: 0.1, K: 30}}]"));
  const auto runs = runAll(suite);
  for (const char* sensor : {"gnss_alone", "dvl"})
    EXPECT_LT(rmse(suite, runs, "clean", "kf27"), rmse(suite, runs, "clean", sensor)) << sensor;
  EXPECT_LT(rmse(suite, runs, "bad", "robust_kf27"), 1.15 * rmse(suite, runs, "clean", "robust_kf27"));
  EXPECT_GT(rmse(suite, runs, "bad", "kf27"), 1.3 * rmse(suite, runs, "bad", "robust_kf27"));
}

TEST(InsSystem, TheBoundIsWhatTheFilterReachesOnGaussianNoise) {
  const auto suite = suiteOf(insSuite(200, 16, "[kf27]", "[{name: clean, gps_outages: [{begin: 120, end: 180}]}]"));
  for (const auto& [group, ratio] : overBound(suite)) {
    EXPECT_GT(ratio, 0.75) << group;  // of 16 runs, each with few independent errors
    EXPECT_LT(ratio, 1.35) << group;
  }
}

TEST(InsSystem, EveryFilterFusesIn27States) {
  const auto suite =
      suiteOf(insSuite(120, 1, "[gnss_alone, kf27, gated_kf27, mckf27, mixture_kf27]", "[{name: clean}]"));
  const auto runs = runAll(suite);
  for (const auto& name : suite.campaigns[0]->estimators)
    EXPECT_LT(rmse(suite, runs, "clean", name), 1.2 * rmse(suite, runs, "clean", "gnss_alone")) << name;
}

TEST(InsSystem, OldNamesMeanThePresentEstimators) {
  const auto suite = suiteOf(insSuite(200, 1, "[gps, ckf27, smooth_robust_ckf27, dvl]", "[{name: clean}]"));
  EXPECT_EQ(suite.campaigns[0]->estimators,
            (std::vector<std::string>{"gnss_alone", "kf27", "steady_robust_kf27", "dvl"}));
}

TEST(InsSystem, SaysWhatIsWrong) {
  expectRefused(insSuite(200, 1, "[kf28]", "[{name: clean}]"), "kf28");
  expectRefused(insSuite(200, 1, "[kf27]", "[]"), "laws");
  expectRefused(insSuite(50, 1, "[kf27]", "[{name: clean}]"), "skip");
  expectRefused(insSuite(200, 1, "[kf27]", "[{name: clean, gps_outages: [{begin: 20, end: 10}]}]"), "end");
  expectRefused(insSuite(200, 1, "[kf27]", "[{name: clean, noise: {law: quantised, quantum: 1}}]"), "quantised");
}

TEST(InsScenario, ReadsItsFileAndRefusesWhatItDoesNotKnow) {
  const auto scenario = ins::Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/ins/survey.yaml");
  EXPECT_DOUBLE_EQ(scenario.parameters.gyro_constant, 0.02 * kDegPerHour);
  EXPECT_DOUBLE_EQ(scenario.track.roll.amplitude, 3 * kRadPerDeg);
  EXPECT_EQ(scenario.parameters.dvl_lever_body, Vector<3>(0.3, 2, -0.5));
  const auto refused = [](const std::string& text) {
    EXPECT_THROW(ins::Scenario::read(YamlSection::fromText(text, "test")), ConfigError) << text;
  };
  refused("{system: usbl}");
  refused("{gps: {sigma: 2}}");
  refused("{gps: {white: [0, 1, 1]}}");
  refused("{imu: {rate: 1}}");
  refused("{start: [89, 0, 0]}");
  refused("{waves: {roll: {amplitude: 1}}}");
  refused("{dpc: {rate: -1}}");
  refused("{dpc: {side: aft}}");
  const auto dpc = ins::Scenario::read(
      YamlSection::fromText("{dpc: {rate: 4, side: port, depression_deg: 30, lever_arm: [1, 2, 3]}}", "test"));
  EXPECT_DOUBLE_EQ(dpc.sensor(ins::Sensor::Dpc).rate, 4);
  EXPECT_TRUE(dpc.dpc.sightBody().isApprox(Vector<3>(-std::cos(kPi / 6), 0, -0.5)));
  EXPECT_EQ(dpc.parameters.dpc_lever_body, Vector<3>(1, 2, 3));
  EXPECT_EQ(scenario.sensor(ins::Sensor::Dpc).rate, 0) << "absent unless asked for";
}

std::vector<double> readingsOfDvl(const ins::Recording& run) {
  std::vector<double> all;
  for (const auto& labelled : run.aiding)
    if (labelled.reading.sensor == ins::Sensor::Dvl) all.push_back(labelled.reading.velocity_body.x());
  return all;
}

TEST(InsScenario, ADvlsMountingChangesItsReadingsAlone) {
  auto scenario = ins::Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/ins/transect_dvl_mounting.yaml");
  EXPECT_DOUBLE_EQ(scenario.parameters.dvl_scale, 0.01);
  EXPECT_DOUBLE_EQ(scenario.parameters.dvl_misalignment, 0.5 * kRadPerDeg);
  scenario.duration = 10;
  auto plain = scenario;
  plain.parameters.dvl_scale = plain.parameters.dvl_misalignment = 0;
  const ins::Trajectory trajectory(scenario.track, scenario.duration);
  auto moved = plain;
  moved.parameters.dvl_lever_sigma = 0.5;
  EXPECT_NE(readingsOfDvl(ins::simulate(moved, trajectory, 3)), readingsOfDvl(ins::simulate(plain, trajectory, 3)));
  const auto mounted = ins::simulate(scenario, trajectory, 3), straight = ins::simulate(plain, trajectory, 3);
  EXPECT_EQ(mounted.imu.back().force_body, straight.imu.back().force_body);
  ASSERT_EQ(mounted.aiding.size(), straight.aiding.size());
  for (std::size_t k = 0; k < mounted.aiding.size(); ++k) {
    const auto &a = mounted.aiding[k].reading, &b = straight.aiding[k].reading;
    EXPECT_EQ(a.fix.latitude, b.fix.latitude);
    if (a.sensor == ins::Sensor::Dvl) {
      EXPECT_GT((a.velocity_body - b.velocity_body).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace sas_motion
