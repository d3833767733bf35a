// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/estimator_scorer.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

Audit audit(Verdict verdict, double weight) {
  Audit one;
  one.sensor = "position";
  one.rows = 2;
  one.S.topLeftCorner<2, 2>() = Matrix<2>::Identity();
  one.nis = 2;
  one.weights << 1, weight, 1;
  one.verdict = verdict;
  return one;
}

TEST(EstimatorScorer, PrecisionAndRecallCountByHand) {
  EstimatorScorer scorer;
  scorer.addAudit(0, audit(Verdict::DownWeighted, 0.1), true);   // hit
  scorer.addAudit(0, audit(Verdict::Rejected, 0.0), true);       // hit
  scorer.addAudit(0, audit(Verdict::Accepted, 0.9), true);       // missed
  scorer.addAudit(0, audit(Verdict::DownWeighted, 0.4), false);  // false alarm
  scorer.addAudit(0, audit(Verdict::Accepted, 1.0), false);
  scorer.addAudit(0, audit(Verdict::Stale, 0), true);  // never fused: not counted
  scorer.addAudit(0, audit(Verdict::Invalid, 0), false);
  scorer.addAudit(0, audit(Verdict::Accepted, 1.0), std::nullopt);
  const Detection detection = scorer.detection();
  EXPECT_NEAR(*detection.precision(), 2.0 / 3, 1e-15);
  EXPECT_NEAR(*detection.recall(), 2.0 / 3, 1e-15);
  EXPECT_EQ(scorer.verdicts()[static_cast<std::size_t>(Verdict::Stale)], 1u);
  EXPECT_EQ(scorer.nis()[0].second.count, 6u);
  EXPECT_FALSE(Detection().precision());
  EXPECT_FALSE(Detection().recall());
}

TEST(EstimatorScorer, LabelsOfRowsAreComparedRowByRow) {
  EstimatorScorer scorer;
  scorer.addAudit(0, audit(Verdict::DownWeighted, 0.1), std::array<bool, 3>{true, false, true});
  const auto& [sensor, detection] = scorer.detections().front();
  EXPECT_EQ(sensor, "position");
  EXPECT_EQ(detection.labelled, 1u) << "the third row is none of the measurement's";
  EXPECT_EQ(detection.flagged, 1u);
  EXPECT_EQ(detection.hits, 0u) << "the rows differ";
}

TEST(EstimatorScorer, TheTraceShowsOneSensorAndTheReportAll) {
  ScorerOptions options;
  options.traced = "position";
  EstimatorScorer scorer("kf", options);
  Audit heading = audit(Verdict::Accepted, 1), smoothed = audit(Verdict::Accepted, 0.7);
  heading.sensor = "heading";
  smoothed.nis = smoothed.S(0, 0) = 0;  // a smoother has no innovations
  scorer.addAudit(1, heading, false);
  scorer.addAudit(2, smoothed, true);
  ASSERT_EQ(scorer.trace().weight_time, std::vector<double>{2});
  EXPECT_EQ(scorer.trace().weight[0], 0.7);
  EXPECT_TRUE(std::isnan(scorer.trace().nis[0]));
  EXPECT_TRUE(scorer.report().nis.empty()) << "without a covariance of its own";
  scorer.addNees("full", 6, 6);
  ASSERT_EQ(scorer.report().nis.size(), 1u);
  EXPECT_EQ(scorer.report().nis[0], std::pair(std::string("heading"), 1.0));
}

TEST(EstimatorScorer, GroupsComeInTheOrderOfTheirFirstErrors) {
  for (const bool by_degree : {false, true}) {
    ScorerOptions options;
    options.square_by_degree = by_degree;
    EstimatorScorer scorer("kf", options);
    for (const double error : {3.0, 4.0}) {
      scorer.addSample(true);
      scorer.addError("position", error);
      scorer.addError("heading", 0.1);
      scorer.addNees("position", error, 2);
    }
    const auto report = scorer.report();
    EXPECT_EQ(report.estimator, "kf");
    EXPECT_EQ(report.samples, 2u);
    ASSERT_EQ(report.errors.size(), 2u);
    EXPECT_EQ(report.errors[0].first, "position");
    EXPECT_NEAR(report.errors[0].second.rmse, std::sqrt(12.5), 1e-15);
    EXPECT_EQ(report.nees[0].second, 3.5 / 2);
    EXPECT_FALSE(report.aperture_across) << "no offsets were added";
  }
}

TEST(EstimatorScorer, DriftIsTheErrorAtTheEndOverTheDistance) {
  EstimatorScorer scorer;
  for (int i = 0; i <= 100; ++i) {
    scorer.addOffset(i, -0.04 * i, 0.03 * i, 2);
    if (i > 0) scorer.addDistance(2);
  }
  EXPECT_NEAR(scorer.drift(), 5.0 / 200, 1e-12);
  EXPECT_LT(scorer.aperture().across, 1e-4);  // a steady drift is no aperture error
}

TEST(EstimatorScorer, WhatIsNotFiniteHasDiverged) {
  EstimatorScorer scorer;
  scorer.addSample(true);
  EXPECT_FALSE(scorer.report().diverged);
  scorer.addSample(false);
  EXPECT_TRUE(scorer.report().diverged);
  EXPECT_EQ(scorer.report().samples, 2u);
}

TEST(EstimatorScorer, KeepsWhatTheSystemFoundOut) {
  EstimatorScorer scorer;
  scorer.facts().locked_out = true;
  scorer.facts().convergence = Convergence{3.0};
  scorer.setCost(1e-3, 0);
  EXPECT_TRUE(scorer.report().locked_out);
  EXPECT_EQ(scorer.report().convergence->after, 3.0);
  EXPECT_NEAR(scorer.report().microseconds, 1000, 1e-9);
}

TEST(ErrorSummary, OfFiveErrors) {
  const auto summary = summarize({3, 4, 0, 0, 0});
  EXPECT_NEAR(summary.rmse, std::sqrt(5.0), 1e-15);
  EXPECT_EQ(summary.max, 4);
  EXPECT_NEAR(summary.p95, 3.8, 1e-12);
}

}  // namespace
}  // namespace sas_motion
