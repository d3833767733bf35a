// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "campaign/suites.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::overBound;
using testing::rmse;
using testing::runAll;
using testing::suiteOf;

std::string sinsSuite(const std::string& scenario, double duration, int runs, const std::string& estimators,
                      const std::string& laws) {
  return "{runs: " + std::to_string(runs) +
         ", campaigns: [{name: sins, system: sins_dvl, scenario: " SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/" +
         scenario + ".yaml, particles: 100, duration: " + std::to_string(duration) +
         ", skip: 30, estimators: " + estimators + ", laws: " + laws + "}]}";
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
      suiteOf(sinsSuite("accuracy", 120, 4, "[ss_srupf, robust_ss_srupf]",
                        "[{name: clean}, {name: bad, noise: {law: contaminated, epsilon: 0.1, K: 50}}]"));
  const auto runs = runAll(suite);
  EXPECT_LT(rmse(suite, runs, "bad", "robust_ss_srupf"), 1.2 * rmse(suite, runs, "clean", "robust_ss_srupf"));
  EXPECT_GT(rmse(suite, runs, "bad", "ss_srupf"), rmse(suite, runs, "bad", "robust_ss_srupf"));
}

TEST(SinsSystem, ReportsParticlesConvergenceAndDrift) {
  const auto suite = suiteOf(
      sinsSuite("large_angle", 60, 1, "[ss_srupf, ukf, kf27]", "[{name: five}, {name: thirty, heading_deg: 30}]"));
  EXPECT_EQ(suite.campaigns[0]->particles, 100);
  for (const auto& reports : runAll(suite)) {
    const auto& found = reports.front();
    ASSERT_EQ(found.errors.back().first, "drift_percent");
    EXPECT_LT(found.errors.back().second.rmse, 5);
    EXPECT_FALSE(found.diverged);
    ASSERT_TRUE(found.effective_size && found.convergence && found.convergence->after && found.aperture_across &&
                found.aperture_wavelengths);
    EXPECT_GE(*found.effective_size, 50);
    EXPECT_GT(*found.convergence->after, 0) << "it begins 5 or 30 degrees off";
    EXPECT_LE(*found.convergence->after, 30) << "and stays for 30 s of 60";
    EXPECT_DOUBLE_EQ(*found.aperture_wavelengths, *found.aperture_across / 0.015);
    EXPECT_FALSE(reports[1].effective_size) << "ukf is a filter alone";
    EXPECT_FALSE(reports[2].effective_size) << "kf27 has no particles";
  }
}

TEST(SinsSystem, AFilterThatRanAwayHasNotConvergedHoweverGoodItsHeading) {
  const auto suite = suiteOf(sinsSuite("large_angle", 100, 1, "[pf]", "[{name: thirty, heading_deg: 30}]"));
  const auto report = runAll(suite).front().front();
  std::map<std::string, double> found;
  for (const auto& [group, error] : report.errors) found[group] = error.rmse;
  EXPECT_LT(found.at("heading"), 2 * kRadPerDeg);
  EXPECT_GT(found.at("velocity"), 0.3);
  EXPECT_FALSE(report.convergence->after);
}

TEST(SinsSystem, ATraceShowsErrorsWithTheirBandsAndTheParticles) {
  const auto suite = suiteOf(sinsSuite("large_angle", 60, 1, "[ss_srupf]", "[{name: thirty, heading_deg: 30}]"));
  const auto trace = suite.campaigns[0]->trace(0, 1).front().second;
  EXPECT_LT(trace.time.front(), 2) << "the start too, which is not scored";
  ASSERT_EQ(trace.others.size(), 3u);
  const auto& [group, heading] = trace.others.back();
  EXPECT_EQ(group, "heading");
  ASSERT_EQ(heading.error.size(), trace.time.size());
  ASSERT_EQ(heading.sigma3.size(), trace.time.size());
  EXPECT_GT(std::abs(heading.error.front()), 20 * kRadPerDeg);
  EXPECT_LT(std::abs(heading.error.back()), heading.sigma3.back());
  EXPECT_EQ(trace.effective_size.size(), 60u) << "one a reading of the DVL";
  EXPECT_EQ(trace.nis.size(), 31u) << "of the DVL, from 30 s on";
  for (const double size : trace.effective_size) EXPECT_TRUE(size >= 1 && size <= 100) << size;
}

TEST(ConvergenceWatch, AsksForAnEstimateThatStaysNearTheTruth) {
  const auto after = [](const std::string& near) {  // a letter a second, n: near; for at least 3 s
    ConvergenceWatch watch(3);
    for (std::size_t i = 0; i < near.size(); ++i) watch.add(static_cast<double>(i), near[i] == 'n');
    return watch.result().after;
  };
  EXPECT_EQ(after("--nnnn"), 2);
  EXPECT_EQ(after("-n-nnnn"), 3) << "passing by is not enough";
  EXPECT_EQ(after("nnnn"), 0);
  EXPECT_EQ(after("---nnn"), std::nullopt) << "two seconds are too short";
  EXPECT_EQ(after("nnnnn-"), std::nullopt) << "it left in the end";
  EXPECT_EQ(after(""), std::nullopt);
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
  const auto refused = [](const std::string& text) {
    EXPECT_THROW(sins::Scenario::read(YamlSection::fromText(text, "test")), ConfigError) << text;
  };
  refused("{system: ins_gps_dvl}");
  refused("{gps: {rate: 1}}");
  refused("{dvl: {white: [0, 1, 1]}}");
  refused("{initial: {heading_deg: 100}}");
  refused("{depth: {noise: {law: quantised, quantum: 1}}}");
}

}  // namespace
}  // namespace sas_motion
