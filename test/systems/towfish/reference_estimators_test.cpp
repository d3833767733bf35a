// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The references that estimators are compared with: the oracle, and the bound with a genie.
#include "systems/towfish/reference_estimators.hpp"

#include <numeric>

#include "campaign/suites.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

using sas_motion::testing::rmse;
using sas_motion::testing::runAll;
using sas_motion::testing::suiteOf;
using sas_motion::testing::zhuSuite;

constexpr const char* kJumps =
    "[{name: clean}, {name: epochs, process: {law: contaminated, epsilon: 0.05, K: 10, epoch: 1}},"
    " {name: states, process: {law: contaminated, epsilon: 0.05, K: 10}},"
    " {name: spells, process: {law: manoeuvre, rate: 0.02, length: 3, K: 10}}]";

/// Mean NEES of an estimator over the runs of a law, over its degrees of freedom.
double nees(const Suite& suite, const std::vector<std::vector<EstimatorReport>>& runs, const std::string& law,
            const std::string& estimator) {
  std::vector<double> values;
  for (std::size_t task = 0; task < runs.size(); ++task)
    for (const auto& report : runs[task])
      if (suite.campaigns[0]->laws[suite.task(task).law].name == law && report.estimator == estimator)
        values.push_back(report.nees.back().second);
  return mean(values);
}

/// The bound on the position over ten seeds.
double bound(const Suite& suite, std::size_t law) {
  std::vector<std::uint64_t> seeds(10);
  std::iota(seeds.begin(), seeds.end(), suite.first_seed);
  const auto found = suite.campaigns[0]->bound(law, seeds);
  return found.empty() ? 0 : found.front().second;
}

TEST(Oracle, FollowsTheJumpsOfTheProcessAndSaysHowWell) {
  const auto suite = suiteOf(zhuSuite(120, 12, "[kf, oracle_kf]", kJumps));
  const auto runs = runAll(suite);
  EXPECT_EQ(rmse(suite, runs, "clean", "oracle_kf"), rmse(suite, runs, "clean", "kf"));
  for (const char* law : {"epochs", "states", "spells"}) {
    EXPECT_LT(rmse(suite, runs, law, "oracle_kf"), rmse(suite, runs, law, "kf")) << law;
    EXPECT_NEAR(nees(suite, runs, law, "oracle_kf"), 1, 0.1) << law;
    EXPECT_GT(nees(suite, runs, law, "kf"), 1.2) << law;
  }
}

TEST(Oracle, TakesEachStepOfTheProcessWhereReadingsAreSecondsApart) {
  auto scenario = testing::zhu2007(300);
  for (const auto sensor : noisySensors()) scenario.sensor(sensor).rate = 0.5;
  scenario.process = testing::contaminated(0.1, 20);  // ten draws for each reading
  const Config config = testing::configFor(scenario);
  std::cout << "seeds 1 to 20\n";
  std::map<std::string, double> squares, normalised, count;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulatedRun run(scenario, seed);
    for (const std::string name : {"kf", kOracle})
      estimate(config, scenario, run, name, makeEstimator, [&](const Output& output) {
        for (const auto& told : output.solutions) {
          if (told.stamp < Simulator::kStart + 20 * kNanosecondsPerSecond) continue;
          squares[name] += (told.belief.mean - run.at(told.stamp)).head<2>().squaredNorm();
          normalised[name] += normalisedSquare<kStates>(Model::difference(told.belief.mean, run.at(told.stamp)),
                                                        told.belief.covariance) /
                              kStates;
          ++count[name];
        }
      });
  }
  EXPECT_LT(squares[kOracle], 0.9 * squares["kf"]);
  EXPECT_NEAR(normalised[kOracle] / count[kOracle], 1, 0.1);
  EXPECT_GT(normalised["kf"] / count["kf"], 1.5);
}

TEST(Oracle, ReachesTheBoundThatKnowsTheJumps) {
  const auto suite = suiteOf(zhuSuite(120, 40, "[oracle_kf]", kJumps));
  const auto runs = runAll(suite);
  for (std::size_t law : {0, 1, 3}) {  // the draws of single states are not told to the bound
    const auto& name = suite.campaigns[0]->laws[law].name;
    EXPECT_NEAR(rmse(suite, runs, name, "oracle_kf") / bound(suite, law), 1, 0.06) << name;
  }
  EXPECT_GT(bound(suite, 1), 1.05 * bound(suite, 0));
}

TEST(TowfishBound, CountsTheReadingsOfEachRunThatAreThere) {
  const auto suite =
      suiteOf(zhuSuite(60, 1, "[kf]",
                       "[{name: clean}, {name: half, sensors: {position: {law: dropout, probability: 0.5}}},"
                       " {name: bursts, sensors: {position: {law: burst, rate: 0.05, length: 10, K: 20}}}]"));
  EXPECT_GT(bound(suite, 1), 1.05 * bound(suite, 0));
  EXPECT_LT(bound(suite, 1), std::sqrt(2.0) * bound(suite, 0));
  EXPECT_GT(bound(suite, 2), 1.05 * bound(suite, 0));
}

TEST(Estimate, HandsOverARunInPartsThatMakeItUp) {
  const auto scenario = testing::zhu2007(60);
  const Config config = testing::configFor(scenario);
  const SimulatedRun run(scenario, 5);
  Output joined;
  int parts = 0;
  const double seconds = estimate(config, scenario, run, "kf", makeEstimator, [&](const Output& part) {
    joined.solutions.insert(joined.solutions.end(), part.solutions.begin(), part.solutions.end());
    joined.audits.insert(joined.audits.end(), part.audits.begin(), part.audits.end());
    ++parts;
  });
  std::vector<Measurement> measurements;
  for (const auto& labelled : run.measurements()) measurements.push_back(labelled.z);
  const auto whole = testing::feed("kf", config, measurements);
  testing::expectSameEstimates(joined, whole, "in parts");
  EXPECT_EQ(joined.audits.size(), whole.audits.size());
  EXPECT_GT(parts, 3);
  EXPECT_GT(seconds, 0);
}

}  // namespace
}  // namespace sas_motion::towfish
