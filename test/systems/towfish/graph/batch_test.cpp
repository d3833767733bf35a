// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/batch.hpp"

#include <cmath>

#include "sas_motion/systems/towfish/rts.hpp"
#include "support.hpp"
#include "systems/towfish/graph/estimators.hpp"

namespace sas_motion::towfish {
namespace {

SmoothingProblem contaminatedProblem(double duration, std::uint64_t seed) {
  std::cout << "seed " << seed << "\n";
  const auto scenario = testing::zhu2007(duration, testing::contaminated(0.1, 10));
  return *buildProblem(testing::simulate(scenario, seed).measurements, testing::configFor(scenario));
}

class BatchAndRts : public ::testing::TestWithParam<LossKind> {};
std::string nameOf(const ::testing::TestParamInfo<LossKind>& info) { return lossName(info.param); }
INSTANTIATE_TEST_SUITE_P(Smoothers, BatchAndRts, ::testing::Values(LossKind::L2, LossKind::Huber, LossKind::Cauchy),
                         nameOf);

TEST_P(BatchAndRts, ReachTheSameOptimumAndTheSameCovariances) {
  const auto problem = contaminatedProblem(60, 1);
  const SmootherOptions options{Loss(GetParam()), 500, 1e-14};
  const auto batch = smoothBatch(problem, options), rts = smoothRts(problem, options);
  ASSERT_EQ(batch.failure, "");
  ASSERT_EQ(rts.failure, "");
  EXPECT_NEAR(rts.cost, batch.cost, 1e-6 * batch.cost);
  ASSERT_EQ(batch.states.size(), rts.states.size());
  double worst = 0, worst_covariance = 0;
  for (std::size_t k = 0; k < problem.nodes(); ++k) {
    const StateMatrix& P = batch.states[k].covariance;
    const StateVector sigma = P.diagonal().cwiseSqrt();
    const StateVector off = Model::difference(rts.states[k].mean, batch.states[k].mean).cwiseQuotient(sigma);
    worst = std::max(worst, off.cwiseAbs().maxCoeff());
    const StateMatrix scaled =
        sigma.cwiseInverse().asDiagonal() * (rts.states[k].covariance - P) * sigma.cwiseInverse().asDiagonal();
    worst_covariance = std::max(worst_covariance, scaled.cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 1e-4) << "standard deviations";
  EXPECT_LT(worst_covariance, 1e-6);
  for (std::size_t j = 0; j < problem.measurements.size(); ++j)
    ASSERT_LT((batch.weights[j] - rts.weights[j]).norm(), 1e-3) << j;
}

TEST(Gnc, TakesTheOutliersOutAndKeepsTheRest) {
  std::cout << "seed 2\n";
  const auto scenario = testing::zhu2007(40, testing::contaminated(0.1, 50));
  const auto run = testing::simulate(scenario, 2);
  const auto problem = *buildProblem(run.measurements, testing::configFor(scenario));
  const auto result = smoothGnc(problem, 0.99);
  ASSERT_EQ(result.failure, "");
  ASSERT_EQ(result.weights.size(), run.labelled.size());
  std::size_t large = 0, caught = 0, good = 0, kept = 0;
  for (std::size_t j = 0; j < run.labelled.size(); ++j) {
    const Measurement& z = run.labelled[j].z;
    for (int row = 0; row < rowsOf(z.sensor); ++row) {
      const bool outlier = run.labelled[j].outlier[static_cast<std::size_t>(row)];
      const bool out = result.weights[j](row) < 0.5;
      const double off =
          std::abs(Model::difference(StateVector::Constant((z.value - Model::expected(z, run.truthAt(z.stamp)))(row)),
                                     StateVector::Zero())(kHeading));
      if (outlier && (z.sensor != Sensor::Heading || off < kPi) && off > 6 * std::sqrt(z.variance(row))) {
        ++large;
        caught += out;
      }
      good += !outlier;
      kept += !outlier && !out;
    }
  }
  ASSERT_GT(large, 50u);
  EXPECT_GT(static_cast<double>(caught), 0.97 * static_cast<double>(large));
  EXPECT_GT(static_cast<double>(kept), 0.96 * static_cast<double>(good));
}

TEST(Batch, WhatCannotBeSolvedIsReportedAndNotThrown) {
  auto problem = contaminatedProblem(6, 3);
  problem.Q[20].setZero();
  EXPECT_NE(smoothBatch(problem, {}).failure, "");
  EXPECT_NE(smoothGnc(problem, 0.99).failure, "");
  problem = contaminatedProblem(6, 3);
  problem.measurements[7].value(0) = std::nan("");
  const auto result = smoothBatch(problem, {});
  EXPECT_TRUE(!result.failure.empty() || std::isfinite(result.cost))
      << "a cost of " << result.cost << " passes for an answer";
}

TEST(Estimators, EveryNameMakesOne) {
  for (const auto& name : estimatorNames()) EXPECT_TRUE(makeAnyEstimator(name, {})) << name;
  EXPECT_TRUE(makeAnyEstimator("robust_kf_tukey", {}));
  EXPECT_FALSE(makeAnyEstimator("no_such_filter", {}));
}

}  // namespace
}  // namespace sas_motion::towfish
