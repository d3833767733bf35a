// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/campaign.hpp"

#include "campaign/suites.hpp"
#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::rmse;
using testing::runAll;
using testing::suiteOf;

const char* const kContaminated = "noise: {law: contaminated, epsilon: 0.1, K: 10}";

/// Figure-eights of 500 s.
std::string usblSuite(int runs, const std::string& estimators, const std::string& laws, const std::string& more = "") {
  return "{runs: " + std::to_string(runs) +
         ", campaigns: [{name: c, system: usbl, scenario: {duration: 500, track: {kind: figure_eight, radius: 56}}, "
         "estimators: " +
         estimators + ", laws: " + laws + more + "}]}";
}

std::map<std::string, double> boundOf(const Suite& suite, std::size_t law) {
  const auto bound = suite.campaigns[0]->bound(law, {1, 2, 3});
  return {bound.begin(), bound.end()};
}

TEST(UsblSystem, ScoresTheLastHundredSecondsByUnknownTheMountingFirst) {
  const auto suite = suiteOf(usblSuite(1, "[hvbckf]", "[{name: clean}]"));
  const auto report = suite.campaigns[0]->run(0, 1)[0];
  EXPECT_EQ(report.samples, 100u);
  std::vector<std::string> groups;
  for (const auto& [name, summary] : report.errors) groups.push_back(name);
  EXPECT_EQ(groups, (std::vector<std::string>{"mounting", "lever", "mounting_x", "mounting_y", "mounting_z", "lever_x",
                                              "lever_y", "lever_z"}));
  double square = 0;
  for (int i = 2; i < 5; ++i) square += std::pow(report.errors[static_cast<std::size_t>(i)].second.rmse, 2);
  EXPECT_NEAR(report.errors[0].second.rmse, std::sqrt(square), 1e-12);
  EXPECT_EQ(suite.campaigns[0]->skip, 400);
}

TEST(UsblSystem, OutliersHurtCkfMoreThanHvbckfWhateverTheMessagesState) {
  const std::string noise(kContaminated);
  const auto suite = suiteOf(usblSuite(12, "[ckf, oracle_ckf, hvbckf]",
                                       "[{name: right, " + noise + "}, {name: large, stated_factor: 25, " + noise +
                                           "}, {name: small, stated_factor: 0.04, " + noise + "}]"));
  const auto runs = runAll(suite);
  for (const char* law : {"right", "large", "small"}) {
    EXPECT_LT(rmse(suite, runs, law, "hvbckf"), 0.6 * rmse(suite, runs, law, "ckf")) << law;
    EXPECT_LT(rmse(suite, runs, law, "oracle_ckf"), 0.6 * rmse(suite, runs, law, "ckf")) << law;
    EXPECT_NEAR(rmse(suite, runs, law, "oracle_ckf"), rmse(suite, runs, "right", "oracle_ckf"), 1e-9)
        << "the oracle is told the truth";
  }
}

TEST(UsblSystem, TheBoundIsOfTheTrueNoiseAndNoOracleBeatsItOnCleanData) {
  const std::string noise(kContaminated);
  const auto suite = suiteOf(
      usblSuite(40, "[oracle_ckf]",
                "[{name: clean}, {name: clean stated wrongly, stated_factor: 25}, {name: bad, " + noise + "}]"));
  const auto clean = boundOf(suite, 0), misstated = boundOf(suite, 1), bad = boundOf(suite, 2);
  for (const auto& [name, value] : clean) {
    EXPECT_NEAR(misstated.at(name), value, 1e-9 * value) << name;
    EXPECT_GT(bad.at(name), 1.05 * value) << name;  // nine tenths of the readings, and a little of the rest
    EXPECT_LT(bad.at(name), 1.15 * value) << name;
  }
  const double ratio = rmse(suite, runAll(suite), "clean", "oracle_ckf") / clean.at("mounting");
  EXPECT_GT(ratio, 0.85);  // 40 runs of three angles: a standard error of some 8 %
  EXPECT_LT(ratio, 1.2);
}

TEST(UsblSystem, TheBoundIsObservabilitysAtTheEnd) {
  const auto suite = suiteOf(usblSuite(1, "[ckf]", "[{name: clean}]", ", skip: 499"));
  usbl::Scenario scenario;
  scenario.duration = 500;
  scenario.track.centre = scenario.transponder_map.head<2>();
  scenario.track.radius = 56;
  usbl::Problem problem;
  for (const auto& labelled : usbl::simulatePings(scenario, 1)) problem.pings.push_back(labelled.ping);
  const auto expected = usbl::observability(problem, scenario.truth).bound;
  const auto bound = suite.campaigns[0]->bound(0, {1});
  for (int i = 0; i < usbl::kStates; ++i)
    EXPECT_NEAR(bound[static_cast<std::size_t>(i) + 2].second, expected(i), 1e-9 * expected(i)) << i;
}

TEST(UsblSystem, AFirstOutlierLocksAnUnguardedFilterInAndNoGuardedOne) {
  const std::string laws =
      "[{name: first, noise: [{law: contaminated, epsilon: 0.1, K: 10}, {law: step, bias: 30, t0: 0, t1: 1.5}], "
      "stated_factor: 0.04}]";
  const auto locked = [&](const std::string& settings) {
    int count = 0;
    for (const auto& reports : runAll(suiteOf(usblSuite(10, "[hvbckf]", laws, settings))))
      count += reports[0].locked_out;
    return count;
  };
  EXPECT_EQ(locked(""), 0);
  EXPECT_GT(locked(", settings: {start_window: 0, check_window: 0}"), 0);
}

TEST(UsblSystem, ACentredCircleIsNotTrustedAndItsDoubtCoversTheTruth) {
  usbl::Scenario scenario;
  scenario.track.kind = usbl::Track::Kind::Circle;
  scenario.track.centre = scenario.transponder_map.head<2>();
  scenario.track.radius = 224;
  std::cout << "seeds 1 to 20\n";
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    usbl::Problem problem;
    for (const auto& labelled : usbl::simulatePings(scenario, seed)) problem.pings.push_back(labelled.ping);
    const auto fit = usbl::fit(problem, usbl::FitOptions());
    const auto found = usbl::observability(problem, fit.x);
    EXPECT_FALSE(found.observable);
    EXPECT_NE(found.verdict.find("fore-and-aft lever arm"), std::string::npos) << found.verdict;
    const auto error = (fit.x - scenario.truth).head<usbl::kStates>().cwiseAbs();
    covered += (error.array() <= 3 * fit.covariance.diagonal().head<usbl::kStates>().array().sqrt()).all();
  }
  EXPECT_GE(covered, 19);
}

TEST(UsblSystem, ModesAreSettings) {
  for (const char* mode : {"direction_cosines", "azimuth_elevation", "azimuth"}) {
    const auto suite =
        suiteOf(usblSuite(3, "[hvbckf]", "[{name: clean}]", std::string(", settings: {mode: ") + mode + "}"));
    const bool bounded = std::string(mode) != "azimuth";
    EXPECT_EQ(!boundOf(suite, 0).empty(), bounded);
    EXPECT_LT(rmse(suite, runAll(suite), "clean", "hvbckf"), 0.05 * kRadPerDeg * std::sqrt(3.0)) << mode;
  }
}

TEST(UsblSystem, ATraceShowsTheConvergence) {
  const auto suite = suiteOf(usblSuite(1, "[hvbckf]", "[{name: clean}]"));
  const auto trace = suite.campaigns[0]->trace(0, 1)[0].second;
  ASSERT_GT(trace.time.size(), 400u);
  EXPECT_LT(trace.time.front(), 65) << "from the first minute on";
  EXPECT_LT(trace.sigma3.back(), 0.5 * trace.sigma3.front());
  EXPECT_EQ(trace.weight.size(), trace.outlier.size());
}

TEST(UsblSystem, SaysWhatIsWrong) {
  expectRefused(usblSuite(1, "[batch]", "[{name: clean}]"), "batch");  // without a factory of fitters
  expectRefused(usblSuite(1, "[]", "[{name: clean}]"), "estimators");
  expectRefused(usblSuite(1, "[ckf]", "[{name: clean, noice: 1}]"), "noice");
  expectRefused(usblSuite(1, "[ckf]", "[{name: clean}]", ", skip: 500"), "skip");
  expectRefused(usblSuite(1, "[ckf]", "[{name: clean}]", ", settings: {mode: sideways}"), "sideways");
  expectRefused("{campaigns: [{name: a, system: usbl, estimators: [ckf]}]}", "scenario");
}

}  // namespace
}  // namespace sas_motion
