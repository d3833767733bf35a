// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/scores.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

TEST(Scores, NeesOfConsistentErrorsLiesInItsBand) {
  Random random = testing::announced(401);
  for (const double inflation : {1.0, 1.2}) {
    Scorer scorer;
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
      scorer.add(estimate, {truth});
    }
    const Scores scores = scorer.scores();
    const auto& full = *scores.nees_full;
    EXPECT_EQ(full.count, 2000u);
    EXPECT_EQ(full.degrees, 6);
    EXPECT_EQ(inflation == 1.0, full.mean > full.lower && full.mean < full.upper) << full.mean;
    for (int group = 0; group < kGroups; ++group) {
      const auto& nees = *scores.nees[static_cast<std::size_t>(group)];
      const double tolerance = 5 * std::sqrt(2 * nees.degrees / 2000) * inflation * inflation;
      EXPECT_NEAR(nees.mean, nees.degrees * inflation * inflation, tolerance) << groupName(static_cast<Group>(group));
    }
    EXPECT_EQ(inflation == 1.0, std::abs(full.inside - 0.95) < 0.02) << full.inside;
  }
}

Audit audit(Verdict verdict, double weight) {
  Audit one;
  one.rows = 2;
  one.S = Matrix<2>::Identity();
  one.nis = 2;
  one.weights << 1, weight;
  one.verdict = verdict;
  return one;
}

TEST(Scores, PrecisionAndRecallCountByHand) {
  Scorer scorer;
  scorer.add(audit(Verdict::DownWeighted, 0.1), true);   // hit
  scorer.add(audit(Verdict::Rejected, 0.0), true);       // hit
  scorer.add(audit(Verdict::Accepted, 0.9), true);       // missed
  scorer.add(audit(Verdict::DownWeighted, 0.4), false);  // false alarm
  scorer.add(audit(Verdict::Accepted, 1.0), false);
  scorer.add(audit(Verdict::Stale, 0), true);  // never fused: not counted
  scorer.add(audit(Verdict::Invalid, 0), false);
  scorer.add(audit(Verdict::Accepted, 1.0), std::nullopt);
  const Detection detection = scorer.scores().detection[0];
  EXPECT_NEAR(*detection.precision(), 2.0 / 3, 1e-15);
  EXPECT_NEAR(*detection.recall(), 2.0 / 3, 1e-15);
  EXPECT_EQ(scorer.scores().verdicts[static_cast<std::size_t>(Verdict::Stale)], 1u);
  EXPECT_EQ(scorer.scores().nis[0]->count, 6u);
  EXPECT_FALSE(Detection().precision());
  EXPECT_FALSE(Detection().recall());
}

TEST(Scores, DriftIsTheErrorAtTheEndOverTheDistance) {
  Scorer scorer;
  for (int i = 0; i <= 100; ++i) {
    Reference truth{StateVector::Zero()};
    truth.state << 2.0 * i, 0, 0, 0, 0, 2;
    Estimate estimate;
    estimate.stamp = i * kNanosecondsPerSecond;
    estimate.belief.mean = truth.state;
    estimate.belief.mean(kEast) += 0.03 * i;
    estimate.belief.mean(kNorth) -= 0.04 * i;
    scorer.add(estimate, truth);
  }
  const Scores scores = scorer.scores();
  EXPECT_NEAR(scores.distance, 200, 1e-9);
  EXPECT_NEAR(scores.drift, 5.0 / 200, 1e-12);
  EXPECT_NEAR(scores.error[kPositionGroup]->max, 5, 1e-12);
  EXPECT_LT(scores.aperture.across, 1e-4);  // a steady drift is no aperture error
}

TEST(Scores, AnUnknownQuantityIsNotScored) {
  Scorer scorer;
  Reference truth{StateVector::Zero()};
  truth.current_known = truth.speed_known = false;
  scorer.add(Estimate(), truth);
  const Scores scores = scorer.scores();
  EXPECT_TRUE(scores.error[kPositionGroup] && scores.error[kHeadingGroup]);
  EXPECT_FALSE(scores.error[kCurrentGroup] || scores.error[kSpeedGroup] || scores.nees_full);
}

TEST(Scores, WhatIsNotFiniteHasDiverged) {
  Scorer scorer;
  Estimate estimate;
  estimate.belief.mean(2) = std::nan("");
  scorer.add(estimate, {StateVector::Zero()});
  EXPECT_TRUE(scorer.scores().diverged);
  EXPECT_FALSE(scorer.scores().error[kPositionGroup]);
}

TEST(Scores, SummaryOfErrors) {
  const auto summary = summarize({3, 4, 0, 0, 0});
  EXPECT_NEAR(summary.rmse, std::sqrt(5.0), 1e-15);
  EXPECT_EQ(summary.max, 4);
  EXPECT_NEAR(summary.p95, 3.8, 1e-12);
}

}  // namespace
}  // namespace sas_motion::towfish
