// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/suites.hpp"
#include "sas_motion/simulation/sins_scenario.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::overBound;
using testing::rmse;
using testing::runAll;
using testing::suiteOf;

std::string sinsSuite(const std::string& scenario, double duration, int runs, const std::string& estimators, const std::string& laws) {
  return "{runs: " + std::to_string(runs) + ", campaigns: [{name: sins, system: sins_dvl, scenario: " SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/" +
         scenario + ".yaml, particles: 100, duration: " + std::to_string(duration) + ", skip: 30, estimators: " + estimators + ", laws: " + laws + "}]}";
}

TEST(SinsSystem, TheBoundIsWhatTheFilterReachesOnGaussianNoise) {
  const auto suite = suiteOf(sinsSuite("accuracy", 120, 20, "[ss_srukf]", "[{name: clean}]"));
  for (const auto& [group, ratio] : overBound(suite)) {
    EXPECT_GT(ratio, 0.65) << group;  // of 20 runs, each with few independent errors
    EXPECT_LT(ratio, 1.4) << group;
  }
}

TEST(SinsSystem, TheRobustFormStandsOutliersOfTheDvl) {
  const auto suite =
      suiteOf(sinsSuite("accuracy", 120, 4, "[ss_srupf, robust_ss_srupf]", "[{name: clean}, {name: bad, noise: {law: contaminated, epsilon: 0.1, K: 50}}]"));
  const auto runs = runAll(suite);
  EXPECT_LT(rmse(suite, runs, "bad", "robust_ss_srupf"), 1.2 * rmse(suite, runs, "clean", "robust_ss_srupf"));
  EXPECT_GT(rmse(suite, runs, "bad", "ss_srupf"), rmse(suite, runs, "bad", "robust_ss_srupf"));
}

TEST(SinsSystem, ReportsParticlesConvergenceAndDrift) {
  const auto suite = suiteOf(sinsSuite("large_angle", 60, 1, "[ss_srupf, ckf27]", "[{name: five}, {name: thirty, heading_deg: 30}]"));
  const auto runs = runAll(suite);
  for (const auto& reports : runs) {
    std::map<std::string, double> found;
    for (const auto& [group, error] : reports.front().errors) found[group] = error.rmse;
    EXPECT_GE(found.at("effective_particles"), 50);
    EXPECT_LT(found.at("converged_after"), 60);
    EXPECT_LT(found.at("drift_percent"), 5);
    EXPECT_FALSE(reports.front().diverged);
    EXPECT_TRUE(reports.front().aperture_across);
  }
}

TEST(SinsSystem, SaysWhatIsWrong) {
  expectRefused(sinsSuite("accuracy", 100, 1, "[ss_srupf2]", "[{name: clean}]"), "ss_srupf2");
  expectRefused(sinsSuite("accuracy", 100, 1, "[pf]", "[]"), "laws");
  expectRefused(sinsSuite("accuracy", 20, 1, "[pf]", "[{name: clean}]"), "skip");
  expectRefused(sinsSuite("accuracy", 100, 1, "[pf]", "[{name: clean, heading_deg: 0}]"), "heading_deg");
}

TEST(SinsScenario, ReadsItsFilesAndRefusesWhatItDoesNotKnow) {
  const auto scenario = sins::Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/large_angle.yaml");
  EXPECT_DOUBLE_EQ(scenario.parameters.accelerometer_constant, 500 * kMicroG);
  EXPECT_DOUBLE_EQ(scenario.parameters.dvl_scale, 0.002);
  EXPECT_DOUBLE_EQ(scenario.parameters.start_heading, 5 * kRadPerDeg);
  EXPECT_TRUE(scenario.misaligned_by_sigma);
  EXPECT_TRUE(scenario.track.along_bow);
  const auto refused = [](const std::string& text) { EXPECT_THROW(sins::Scenario::read(YamlSection::fromText(text, "test")), ConfigError) << text; };
  refused("{system: ins_gps_dvl}");
  refused("{gps: {rate: 1}}");
  refused("{dvl: {white: [0, 1, 1]}}");
  refused("{initial: {heading_deg: 100}}");
  refused("{depth: {noise: {law: quantised, quantum: 1}}}");
}

}  // namespace
}  // namespace sas_motion
