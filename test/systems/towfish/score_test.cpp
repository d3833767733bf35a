// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "support.hpp"
#include "systems/towfish/campaign.hpp"

namespace sas_motion::towfish {
namespace {

TEST(TowfishScore, NeesOfConsistentErrorsLiesInItsBand) {
  Random random = testing::announced(401);
  for (const double inflation : {1.0, 1.2}) {
    EstimatorScorer scorer;
    Random own = random;
    for (int i = 0; i < 2000; ++i) {
      Estimate estimate;
      estimate.stamp = i * kNanosecondsPerSecond;
      const StateMatrix P = 0.01 * testing::randomCovariance<6>(own);
      estimate.belief.covariance = P;
      StateVector truth = StateVector::Zero();
      truth(kHeading) = kPi;  // errors wrap here
      estimate.belief.mean = truth + inflation * StateMatrix(P.llt().matrixL()) * testing::randomMatrix<6>(own);
      estimate.belief.mean(kHeading) = wrapAngle(estimate.belief.mean(kHeading));
      score(estimate, truth, scorer);
    }
    const auto all = scorer.nees();
    ASSERT_EQ(all.size(), 5u);
    const auto& [name, full] = all.back();
    EXPECT_EQ(name, "full");
    EXPECT_EQ(full.count, 2000u);
    EXPECT_EQ(full.degrees, 6);
    EXPECT_EQ(inflation == 1.0, full.mean > full.lower && full.mean < full.upper) << full.mean;
    for (const auto& [group, nees] : all) {
      const double tolerance = 5 * std::sqrt(2 * nees.degrees / 2000) * inflation * inflation;
      EXPECT_NEAR(nees.mean, nees.degrees * inflation * inflation, tolerance) << group;
    }
    EXPECT_EQ(inflation == 1.0, std::abs(full.inside - 0.95) < 0.02) << full.inside;
  }
}

TEST(TowfishScore, WhatIsNotFiniteHasDivergedAndHasNoErrors) {
  EstimatorScorer scorer;
  Estimate estimate;
  estimate.belief.mean(2) = std::nan("");
  score(estimate, StateVector::Zero(), scorer);
  EXPECT_TRUE(scorer.report().diverged);
  EXPECT_TRUE(scorer.errors().empty());
}

TEST(TowfishScore, WhatHasNoVarianceHasNoNees) {
  EstimatorScorer scorer;
  Estimate estimate;
  estimate.belief.covariance.setIdentity();
  estimate.belief.covariance(kHeading, kHeading) = 0;
  score(estimate, StateVector::Zero(), scorer);
  EXPECT_EQ(scorer.errors().size(), 4u);
  for (const auto& [group, nees] : scorer.nees()) EXPECT_NE(group, "heading");
}

}  // namespace
}  // namespace sas_motion::towfish
