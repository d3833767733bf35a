// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/suites.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::rmse;
using testing::runAll;
using testing::suiteOf;
using testing::zhuSuite;

const char* const kTwoLaws = "[{name: clean}, {name: bad, noise: {law: contaminated, epsilon: 0.2, K: 20}}]";

TEST(Suite, TasksAreNumberedByCampaignLawAndSeed) {
  auto suite = suiteOf(
      "{runs: 3, first_seed: 7, campaigns: [{name: a, system: constant_velocity, estimators: [kf], laws: [{name: x}, "
      "{name: y}]},"
      " {name: b, system: constant_velocity, estimators: [kf], laws: [{name: z}]}]}");
  EXPECT_EQ(suite.tasks(), 9u);
  EXPECT_EQ(suite.firstTask(1), 6u);
  EXPECT_EQ(suite.task(4).campaign->laws[suite.task(4).law].name, "y");
  EXPECT_EQ(suite.task(4).seed, 8u);
  EXPECT_EQ(suite.task(8).campaign->title, "b");
  EXPECT_EQ(suite.task(8).seed, 9u);
  suite.runs = 1;
  EXPECT_EQ(suite.task(2).campaign->title, "b");
}

TEST(Suite, TheHashCoversAllButTheNumberOfRuns) {
  const std::string text = zhuSuite(40, 3, "[kf]", kTwoLaws);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    return suiteOf(other.replace(other.find(from), from.size(), to)).hash;
  };
  const auto hash = suiteOf(text).hash;
  EXPECT_EQ(hash, changed("runs: 3", "runs: 5"));
  EXPECT_NE(hash, changed("K: 20", "K: 21"));
  EXPECT_NE(hash, changed("[kf]", "[rts]"));
  EXPECT_NE(hash, suiteOf(zhuSuite(41, 3, "[kf]", kTwoLaws)).hash) << "another scenario file";
}

TEST(Suite, SaysWhatIsWrong) {
  expectRefused("{runs: 3}", "campaigns");
  expectRefused("{campaigns: [{name: a, system: balloon}]}", "balloon");
  expectRefused("{campaigns: [{name: a, system: constant_velocity, estimators: [kalmann], laws: [{name: x}]}]}",
                "kalmann");
  expectRefused("{campaigns: [{name: a, system: constant_velocity, estimators: [kf]}]}", "laws");
  expectRefused("{campaigns: [{name: a, system: constant_velocity, estimators: [kf], skip: 200, laws: [{name: x}]}]}",
                "skip");
  expectRefused(
      "{campaigns: [{name: a, system: constant_velocity, estimators: [kf], laws: [{name: x, nois: {law: gaussian}}]}]}",
      "nois");
  expectRefused("{campaigns: [{system: towfish}]}", "name");
  expectRefused(zhuSuite(40, 1, "[kalmann]", kTwoLaws), "kalmann");
  expectRefused(zhuSuite(10, 1, "[kf]", kTwoLaws), "skip");
}

TEST(Suite, ACampaignReadsScenarioDurationAndLawsInEverySystem) {
  const auto suite = suiteOf(
      "{campaigns: [{name: a, scenario: {duration: 60}, duration: 40, estimators: [kf]},"
      " {name: b, system: usbl, scenario: {duration: 60}, duration: 500, estimators: [ckf], laws: []}]}");
  const auto &towfish = *suite.campaigns[0], &usbl = *suite.campaigns[1];
  EXPECT_EQ(towfish.duration, 40) << "the campaign's goes over the scenario's";
  EXPECT_EQ(towfish.skip, 20);
  ASSERT_EQ(towfish.laws.size(), 1u);
  EXPECT_EQ(towfish.laws[0].name, "as in the scenario");
  EXPECT_EQ(usbl.duration, 500);
  EXPECT_EQ(usbl.skip, 400) << "the last hundred seconds are scored";
  ASSERT_EQ(usbl.laws.size(), 1u);
  EXPECT_EQ(usbl.laws[0].name, usbl.laws[0].description);
}

TEST(Suite, TheSuitesInTheRepositoryCanBeRead) {
  const auto any = [](const std::string&, const towfish::Config& config) {
    return towfish::makeEstimator("kf", config);
  };  // some need the factor graph
  const auto native = [](const std::string&) -> usbl::Fitter {
    return [](const auto& problem, const auto& options) { return usbl::fit(problem, options); };
  };
  const auto any_ins = [](const std::string&, const ins::Config& config) { return ins::makeEstimator("kf27", config); };
  const auto any_sins = [](const std::string&, const sins::Config& config) {
    return sins::makeEstimator("kf27", config);
  };
  const auto readers = testing::readers(any_ins, any_sins, any, native);
  int suites = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(SAS_MOTION_SOURCE_DIR) / "config" / "suites")) {
    ASSERT_NO_THROW(EXPECT_GT(Suite::fromFile(entry.path(), readers).tasks(), 0u)) << entry.path();
    ++suites;
  }
  EXPECT_GE(suites, 4);
}

TEST(TowfishSystem, TheOracleIsTheKalmanFilterOnCleanDataAndBetterOnBad) {
  const auto suite = suiteOf(zhuSuite(60, 4, "[kf, oracle_kf]", kTwoLaws));
  const auto runs = runAll(suite);
  EXPECT_EQ(rmse(suite, runs, "clean", "kf"), rmse(suite, runs, "clean", "oracle_kf"));
  EXPECT_LT(rmse(suite, runs, "bad", "oracle_kf"), 0.6 * rmse(suite, runs, "bad", "kf"));
  EXPECT_EQ(runs[0][0].samples, 401u);  // 20 to 60 s at 10 Hz
}

TEST(TowfishSystem, ALawMayBeOfOneSensorOnly) {
  const auto suite = suiteOf(zhuSuite(60, 2, "[kf]",
                                      "[{name: clean}, {name: none, sensors: {speed: {law: gaussian}}},"
                                      " {name: speed, sensors: {speed: {law: contaminated, epsilon: 0.3, K: 30}}}]"));
  const auto runs = runAll(suite);
  EXPECT_EQ(rmse(suite, runs, "clean", "kf"), rmse(suite, runs, "none", "kf"));
  EXPECT_GT(rmse(suite, runs, "speed", "kf"), 1.05 * rmse(suite, runs, "clean", "kf"));
}

TEST(OrderedTasks, ComeInOrderWhateverTheThreads) {
  for (const int jobs : {1, 2, 5}) {
    std::vector<std::size_t> seen;
    inOrder(
        3, 200, jobs, [](std::size_t task) { return task; }, [&](std::size_t task) { seen.push_back(task); });
    ASSERT_EQ(seen.size(), 197u);
    for (std::size_t i = 0; i < seen.size(); ++i) ASSERT_EQ(seen[i], i + 3);
  }
}

TEST(OrderedTasks, AFailureReachesTheCaller) {
  const auto fails = [](std::size_t task) -> int { return task == 20 ? throw std::runtime_error("no estimator") : 0; };
  EXPECT_THROW(inOrder(0, 100, 2, fails, [](int) {}), std::runtime_error);
  EXPECT_THROW(inOrder(
                   0, 100, 2, [](std::size_t) { return 0; }, [](int) { throw std::runtime_error("no disk"); }),
               std::runtime_error);
}

TEST(LockOut, IsAnErrorBeyondFiveSigmaForMoreThanFiveEpochs) {
  const auto locked = [](const std::vector<double>& ratios) {
    LockOut lock_out(0.5);
    for (std::size_t i = 0; i < ratios.size(); ++i) lock_out.add(0.5 * static_cast<double>(i), ratios[i]);
    return lock_out.lockedOut();
  };
  EXPECT_FALSE(locked({6, 6, 6, 6, 6}));
  EXPECT_TRUE(locked({6, 6, 6, 6, 6, 6}));
  EXPECT_FALSE(locked({6, 6, 6, 4, 6, 6, 6}));
}

}  // namespace
}  // namespace sas_motion
