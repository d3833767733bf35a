// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/monte_carlo.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "sas_motion/evaluation/ensemble.hpp"
#include "support.hpp"

namespace sas_motion::towfish {
namespace {

Campaign shortCampaign() {
  Campaign campaign;
  campaign.scenario = testing::zhu2007(40);
  campaign.config = testing::configFor(campaign.scenario);
  campaign.laws = {{"clean", NoiseLaw{}}, {"bad", testing::contaminated(0.2, 20)}};
  campaign.estimators = {"kf", kOracle};
  campaign.runs = 4;
  campaign.first_seed = 10;
  campaign.skip = 10;
  return campaign;
}

TEST(MonteCarlo, ThreadsChangeNeitherOrderNorNumbers) {
  const auto campaign = shortCampaign();
  std::atomic<int> done{0};
  const auto one = runCampaign(campaign, 1, makeEstimator, [&] { ++done; });
  const auto two = runCampaign(campaign, 2, makeEstimator, [] {});
  EXPECT_EQ(done, 8);
  ASSERT_EQ(one.size(), 16u);
  ASSERT_EQ(two.size(), one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].law, i < 8 ? "clean" : "bad");
    EXPECT_EQ(one[i].seed, 10 + i / 2 % 4);
    EXPECT_EQ(one[i].estimator, i % 2 ? kOracle : "kf");
    EXPECT_EQ(one[i].scores.error[kPositionGroup]->rmse, two[i].scores.error[kPositionGroup]->rmse);
    EXPECT_EQ(one[i].scores.samples, 301u);  // 10 to 40 s at 10 Hz
  }
}

TEST(MonteCarlo, TheOracleIsTheKalmanFilterOnCleanDataAndBetterOnBad) {
  const auto results = runCampaign(shortCampaign(), 2, makeEstimator, [] {});
  for (std::size_t i = 0; i < results.size(); i += 2) {
    const double kf = results[i].scores.error[kPositionGroup]->rmse, oracle = results[i + 1].scores.error[kPositionGroup]->rmse;
    if (results[i].law == "clean")
      EXPECT_EQ(kf, oracle);
    else
      EXPECT_LT(oracle, 0.6 * kf);
  }
}

TEST(MonteCarlo, TheNeesOfTheKalmanFilterLiesInItsBandAndOfABadOneDoesNot) {
  auto campaign = shortCampaign();
  campaign.scenario.duration = 120;
  campaign.runs = 40;
  std::map<std::string, std::vector<std::vector<double>>> nees;
  for (const auto& result : runCampaign(campaign, 2, makeEstimator, [] {})) {
    ASSERT_EQ(result.nees.size(), 110u);
    nees[result.law + " " + result.estimator].push_back(result.nees);
  }
  for (const char* right : {"clean kf", "clean oracle_kf", "bad oracle_kf"}) {
    const auto ensemble = ensembleConsistency(nees[right], kStates);
    EXPECT_EQ(ensemble.times, 110u) << right;
    EXPECT_GT(ensemble.inside, 0.85) << right;  // some 25 independent times: 0.04 is one sigma
  }
  EXPECT_EQ(ensembleConsistency(nees["bad kf"], kStates).inside, 0);
}

TEST(MonteCarlo, AFailureInAThreadReachesTheCaller) {
  const auto broken = [](const std::string&, const Config&) -> std::unique_ptr<Estimator> { throw std::runtime_error("no estimator"); };
  EXPECT_THROW(runCampaign(shortCampaign(), 2, broken, [] {}), std::runtime_error);
}

TEST(MonteCarlo, TheSuitesInTheRepositoryCanBeRead) {
  const std::filesystem::path folder = std::filesystem::path(SAS_MOTION_SOURCE_DIR) / "config" / "suites";
  int suites = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    Campaign campaign;
    ASSERT_NO_THROW(campaign = Campaign::fromFile(entry.path())) << entry.path();
    EXPECT_FALSE(campaign.estimators.empty());
    ++suites;
  }
  EXPECT_GE(suites, 1);
}

}  // namespace
}  // namespace sas_motion::towfish
