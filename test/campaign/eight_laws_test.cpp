// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The eight laws on the textbook problem: what bank_kf promises, with room for the few seeds of a test.
#include "campaign/suites.hpp"

namespace sas_motion {
namespace {

Suite eightLaws(int runs) {
  Suite suite = Suite::fromFile(std::string(SAS_MOTION_SOURCE_DIR) + "/config/suites/eight_laws.yaml", towfish::makeEstimator);
  suite.runs = runs;
  suite.campaigns[0]->estimators = {"kf", "oracle_kf", "bank_kf"};
  return suite;
}

TEST(EightLaws, TheBankIsNearTheOracleUnderEveryLawWithOneTuning) {
  const auto suite = eightLaws(60);
  const auto runs = testing::runAll(suite);
  const std::vector<double> most{1.03, 1.10, 1.06, 1.12, 1.25, 1.09, 1.25, 1.10};
  for (std::size_t law = 0; law < most.size(); ++law) {
    const auto& name = suite.campaigns[0]->laws[law].name;
    const double ratio = testing::rmse(suite, runs, name, "bank_kf") / testing::rmse(suite, runs, name, "oracle_kf");
    EXPECT_LT(ratio, most[law]) << name;
    EXPECT_GT(ratio, 0.97) << name << ": nothing beats what is told the truth";
  }
}

TEST(EightLaws, TheBankIsAsSureAsItMayBeAndLocksOutOfNothing) {
  const auto suite = eightLaws(60);
  std::map<std::string, std::vector<double>> nees;
  int locked_out = 0;
  const auto runs = testing::runAll(suite);
  for (std::size_t task = 0; task < runs.size(); ++task) {
    const EstimatorReport& bank = runs[task][2];
    nees[suite.campaigns[0]->laws[suite.task(task).law].name].push_back(bank.nees.front().second);
    locked_out += bank.locked_out;
    EXPECT_FALSE(bank.diverged);
  }
  for (const auto& [law, values] : nees) {
    EXPECT_GT(mean(values), 0.78) << law;
    EXPECT_LT(mean(values), 1.2) << law;
  }
  EXPECT_LE(locked_out, 2) << "of " << runs.size();
}

}  // namespace
}  // namespace sas_motion
