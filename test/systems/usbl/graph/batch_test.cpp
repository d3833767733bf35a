// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/graph/batch.hpp"

#include <cmath>

#include "systems/usbl/graph/problems.hpp"

namespace sas_motion::usbl {
namespace {

using testing::figureEight;
using testing::simulatedProblem;

const FitOptions kExact{Loss(LossKind::Huber), false, 500, 1e-15};

/// The largest difference of two fits' unknowns in standard deviations.
double apart(const Fit& a, const Fit& b, const Prior& prior) {
  double largest = 0;
  for (int i = 0; i < kUnknowns; ++i)
    largest = std::max(largest, prior.estimated[static_cast<std::size_t>(i)]
                                    ? std::abs(a.x(i) - b.x(i)) / std::sqrt(b.covariance(i, i))
                                    : 1e9 * std::abs(a.x(i) - b.x(i)));
  return largest;
}

void expectTwins(const Problem& problem, const FitOptions& options, const std::string& what) {
  const Unknowns start = problem.prior.mean;
  const Fit native = solveIteratively(problem, options, start), graph = solveFactorGraph(problem, options, start);
  ASSERT_EQ(native.failure, "") << what;
  ASSERT_EQ(graph.failure, "") << what;
  EXPECT_TRUE(graph.converged) << what;
  EXPECT_NEAR(graph.cost, native.cost, 1e-9 * native.cost) << what;
  EXPECT_LT(apart(graph, native, problem.prior), 1e-6) << what;
  EXPECT_LT(sas_motion::testing::relativeDifference(graph.covariance, native.covariance), 1e-6) << what;
  ASSERT_EQ(graph.weights.size(), native.weights.size()) << what;
}

TEST(UsblBatch, ReachesTheNativeOptimumInEveryModeAndForEveryConvexLoss) {
  for (const auto& mode : modeNames())
    for (const LossKind kind : {LossKind::L2, LossKind::Huber, LossKind::PseudoHuber}) {
      const Problem problem = simulatedProblem(figureEight(400), 3, modeFromName(mode));
      FitOptions options = kExact;
      options.loss = Loss(kind);
      expectTwins(problem, options, mode + ", " + lossName(kind));
    }
}

TEST(UsblBatch, ReachesTheNativeOptimumWithTransponderAndSoundSpeedUnknown) {
  Scenario scenario = figureEight(400);
  scenario.truth.tail<4>() << 0.1, -0.05, 0.08, 2e-3;
  Problem problem = simulatedProblem(scenario, 4);
  problem.prior.estimated[kRangeScale] = true;
  expectTwins(problem, kExact, "scale");
  testing::estimateAll(problem.prior);
  expectTwins(problem, kExact, "scale and transponder");
  const Fit fit = solveFactorGraph(problem, kExact, problem.prior.mean);
  EXPECT_NEAR(fit.x(kRangeScale), 2e-3, 4 * std::sqrt(fit.covariance(kRangeScale, kRangeScale)));
}

TEST(UsblBatch, HoldsWhatIsKnownWithinAVariable) {
  Problem problem = simulatedProblem(figureEight(400), 5);
  problem.prior.mean(kMountingZ) = 3 * kRadPerDeg;
  problem.prior.mean(kLeverZ) = 1;
  problem.prior.estimated[kMountingZ] = problem.prior.estimated[kLeverZ] = false;
  const Fit fit = solveFactorGraph(problem, kExact, problem.prior.mean);
  ASSERT_EQ(fit.failure, "");
  EXPECT_NEAR(fit.x(kMountingZ), 3 * kRadPerDeg, 1e-9);
  EXPECT_NEAR(fit.x(kLeverZ), 1, 1e-9);
  const Fit native = solveIteratively(problem, kExact, problem.prior.mean);
  EXPECT_NEAR(fit.cost, native.cost, 1e-9 * native.cost);
}

TEST(UsblBatch, MarginalsAreTheInverseOfTheInformation) {
  Problem problem = simulatedProblem(figureEight(400), 6);
  testing::estimateAll(problem.prior);
  const Unknowns x = Scenario::defaultTruth();
  const auto graph = buildGraph(problem, Loss(LossKind::L2), x);
  const Matrix<kUnknowns> expected = covarianceFrom(information(problem, x), problem.prior);
  EXPECT_LT(sas_motion::testing::relativeDifference(marginalCovariance(graph, problem.prior, x), expected), 1e-9);
}

TEST(UsblBatch, ARedescendingLossFindsTheTruthBesideTheScale) {
  const Problem problem = simulatedProblem(figureEight(600, 30), 7);
  FitOptions options;
  options.loss = Loss(LossKind::Tukey);
  const Fit native = fit(problem, options), graph = fit(problem, options, solveFactorGraph);
  ASSERT_EQ(graph.failure, "");
  EXPECT_LT(apart(graph, native, problem.prior), 1e-3);
  const Unknowns truth = Scenario::defaultTruth();
  for (int i = 0; i < kStates; ++i)
    EXPECT_LT(std::abs(graph.x(i) - truth(i)), 4 * std::sqrt(graph.covariance(i, i)))
        << unknownNames()[static_cast<std::size_t>(i)];
}

TEST(UsblGnc, FindsTheOutliersAndKeepsTheRest) {
  std::cout << "seed 8\n";
  const auto labelled = simulatePings(figureEight(400, 50), 8);
  const Problem problem = testing::problemFrom(labelled);
  const Fit result = makeFitter("gnc")(problem, FitOptions());
  ASSERT_EQ(result.failure, "");
  ASSERT_EQ(result.weights.size(), labelled.size());
  const Unknowns truth = Scenario::defaultTruth();
  int large = 0, caught = 0, good = 0, kept = 0;
  for (std::size_t k = 0; k < labelled.size(); ++k) {
    const Vector<kChannels> error = normalisedResidual(problem, labelled[k].ping, truth);
    for (int i = 0; i < kChannels; ++i) {
      const bool outlier = labelled[k].outlier[static_cast<std::size_t>(i)], in = result.weights[k](i) > 0.5;
      if (outlier && std::abs(error(i)) > 5) ++large, caught += !in;
      if (!outlier) ++good, kept += in;
    }
  }
  EXPECT_GT(large, 80);
  EXPECT_EQ(caught, large);
  EXPECT_GT(kept, 0.97 * good);
  for (int i = 0; i < kStates; ++i)
    EXPECT_LT(std::abs(result.x(i) - truth(i)), 4 * std::sqrt(result.covariance(i, i)))
        << unknownNames()[static_cast<std::size_t>(i)];
}

TEST(UsblBatch, WithoutPingsThePriorIsAllThatIsKnown) {
  Problem problem;
  problem.prior.mean = Scenario::defaultTruth();
  for (const char* name : {"batch", "gnc"}) {
    const Fit fit = makeFitter(name)(problem, FitOptions());
    EXPECT_EQ(fit.failure, "") << name;
    EXPECT_LT((fit.x - problem.prior.mean).norm(), 1e-9) << name;
    for (int i = 0; i < kStates; ++i)
      EXPECT_NEAR(std::sqrt(fit.covariance(i, i)), problem.prior.sigma(i), 1e-6 * problem.prior.sigma(i)) << name;
  }
}

TEST(UsblBatch, ACentredCircleIsSolvedWithTheDoubtThatItLeaves) {
  Scenario scenario = figureEight(400);
  scenario.track.kind = Track::Kind::Circle;
  const Problem problem = simulatedProblem(scenario, 9);
  for (const char* name : {"batch", "gnc"}) {
    const Fit fit = makeFitter(name)(problem, FitOptions());
    EXPECT_EQ(fit.failure, "") << name;
    EXPECT_GT(std::sqrt(fit.covariance(kLeverY, kLeverY)), 0.3)
        << name << ": the fore-and-aft arm hides behind the pitch angle";
    const Unknowns truth = Scenario::defaultTruth();
    for (int i = 0; i < kStates; ++i)
      EXPECT_LT(std::abs(fit.x(i) - truth(i)), 4 * std::sqrt(fit.covariance(i, i)))
          << name << unknownNames()[static_cast<std::size_t>(i)];
  }
}

TEST(UsblBatch, WhatFailsIsData) {
  Problem problem = simulatedProblem(figureEight(60), 10);
  problem.pings[3].C_body_map.setConstant(NAN);
  EXPECT_NE(solveFactorGraph(problem, kExact, problem.prior.mean).failure, "");
  Problem good = simulatedProblem(figureEight(60), 10);
  FitOptions hasty = kExact;
  hasty.max_iterations = 1;
  EXPECT_NE(solveFactorGraph(good, hasty, good.prior.mean).failure, "");
  EXPECT_FALSE(makeFitter("ckf"));
}

}  // namespace
}  // namespace sas_motion::usbl
