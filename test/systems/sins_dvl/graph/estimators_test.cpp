// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/sins_dvl/graph/estimators.hpp"

#include "campaign/suites.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"
#include "systems/ins_gps_dvl/graph/runs.hpp"

namespace sas_motion::sins {
namespace {

Scenario largeAngle(double heading_deg, double duration) {
  auto scenario = Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/large_angle.yaml");
  scenario.duration = duration;
  scenario.parameters.start_heading = heading_deg * kRadPerDeg;
  return scenario;
}

ins::Recording recordingOf(const Scenario& scenario, std::uint64_t seed) {
  return simulate(scenario, ins::Trajectory(scenario.track, scenario.duration), seed);
}

ins::Output outputOf(const std::string& name, const Scenario& scenario, const ins::Recording& recording) {
  Config config;
  config.parameters = scenario.parameters;
  config.particles.particles = 20;
  const auto estimator = makeAnyEstimator(name, config);
  const auto output = ins::testing::outputOf(*estimator, recording);
  EXPECT_EQ(estimator->failure(), "") << name;
  return output;
}

double headingError(const ins::NavigationSolution& solution, const Scenario& scenario) {
  const auto truth = ins::Trajectory(scenario.track, scenario.duration).at(secondsBetween(0, solution.stamp)).state;
  return attitudeError(solution.state.q_nav_body, truth.q_nav_body).z();
}

std::string suiteText(const std::string& scenario, double duration, int runs, const std::string& laws) {
  return "{runs: " + std::to_string(runs) +
         ", campaigns: [{name: sins, system: sins_dvl, scenario: " SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/" +
         scenario + ".yaml, duration: " + std::to_string(duration) + ", skip: 30, estimators: [batch], laws: " + laws +
         "}]}";
}

Suite suiteOf(const std::string& text) {
  return sas_motion::testing::suiteOf(text, sas_motion::testing::readers(ins::makeEstimator, makeAnyEstimator));
}

TEST(SinsEstimators, AnswerToEveryName) {
  const Scenario scenario = largeAngle(5, 10);
  const auto recording = recordingOf(scenario, 1);
  for (const auto& name : anyEstimatorNames()) {
    const auto output = outputOf(name, scenario, recording);
    EXPECT_GE(output.solutions.size() + 1, recording.imu.size()) << name;
    EXPECT_EQ(output.audits.size(), recording.aiding.size()) << name;
  }
  EXPECT_FALSE(makeAnyEstimator("no_such_estimator", {}));
}

TEST(SinsEstimators, BatchFindsTheSameOptimumFromAHeadingThatIsThirtyDegreesOff) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    // GIVEN a run, and a start whose heading is right and one that is 30 degrees wrong, both believed within 30 degrees
    const Scenario scenario = largeAngle(30, 60);
    const auto wrong = recordingOf(scenario, seed);
    auto right = wrong;
    right.start.q_nav_body = ins::Trajectory(scenario.track, scenario.duration).at(0).state.q_nav_body;
    const auto from_wrong = outputOf("batch", scenario, wrong), from_right = outputOf("batch", scenario, right);
    // THEN they differ by what the beliefs differ in: 30 degrees by the share of the belief in what is known at the
    // end, (1/30)^2
    ASSERT_EQ(from_wrong.solutions.size(), from_right.solutions.size());
    for (std::size_t k = 0; k < from_wrong.solutions.size(); k += 500) {
      const auto &a = from_wrong.solutions[k], &b = from_right.solutions[k];
      EXPECT_LT(attitudeError(a.state.q_nav_body, b.state.q_nav_body).norm(), 0.1 * kRadPerDeg) << "seed " << seed;
      EXPECT_LT(displacement(b.state, a.state).norm(), 0.002 * 180) << "seed " << seed;
    }
  }
}

TEST(SinsEstimators, BothGraphsConvergeWhereTheFilterBySmallAnglesDoesNot) {
  const Scenario scenario = largeAngle(30, 120);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto recording = recordingOf(scenario, seed);
    for (const char* name : {"batch", "fixed_lag"})
      EXPECT_LT(std::abs(headingError(outputOf(name, scenario, recording).solutions.back(), scenario)), 3 * kRadPerDeg)
          << name << ", seed " << seed;
  }
}

TEST(SinsEstimators, ErrorsOfBatchFromThirtyDegreesAreAsLargeAsItsCovarianceSays) {
  const auto suite = suiteOf(suiteText("large_angle", 60, 20, "[{name: thirty, heading_deg: 30}]"));
  double nees = 0;
  const auto runs = sas_motion::testing::runAll(suite);
  for (const auto& reports : runs)
    for (const auto& [group, value] : reports.front().nees)
      if (group == "full") nees += value / static_cast<double>(runs.size());
  EXPECT_GT(nees, 0.7) << "errors hardly change in a run: 20 of nine, 99 % of chi-square are 0.77 to 1.26";
  EXPECT_LT(nees, 1.35);
}

TEST(SinsEstimators, BatchStandsOutliersOfTheDvl) {
  const auto suite = suiteOf(
      suiteText("accuracy", 120, 5, "[{name: clean}, {name: bad, noise: {law: contaminated, epsilon: 0.1, K: 50}}]"));
  const auto runs = sas_motion::testing::runAll(suite);
  EXPECT_LT(sas_motion::testing::rmse(suite, runs, "bad", "batch"),
            1.2 * sas_motion::testing::rmse(suite, runs, "clean", "batch"));
}

}  // namespace
}  // namespace sas_motion::sins
