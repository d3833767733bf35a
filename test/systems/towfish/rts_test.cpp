// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/rts.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

using Dense = Eigen::MatrixXd;

SmoothingProblem problemOf(const Scenario& scenario, std::uint64_t seed) {
  std::cout << "seed " << seed << "\n";
  return *buildProblem(testing::simulate(scenario, seed).measurements, testing::configFor(scenario));
}

/// The whole least-squares problem as one dense whitened system, by Gauss-Newton: J dx = r.
struct DenseSystem {
  Dense J;
  Eigen::VectorXd r;
  DenseSystem(const SmoothingProblem& p, const Loss& loss, const std::vector<StateVector>& x) {
    const auto n = static_cast<Eigen::Index>(6 * p.nodes());
    J.setZero(n + static_cast<Eigen::Index>(2 * p.measurements.size()), n);
    r.setZero(J.rows());
    const StateMatrix P_root = StateMatrix(p.prior.covariance.llt().matrixL()).inverse();
    J.topLeftCorner(6, 6) = P_root;
    r.head(6) = P_root * Model::difference(p.prior.mean, x[0]);
    for (std::size_t k = 1; k < p.nodes(); ++k) {
      const auto row = static_cast<Eigen::Index>(6 * k);
      const auto step = p.model.transition(x[k - 1], p.inputs[k], p.dt(k));
      const StateMatrix Q_root = StateMatrix(p.Q[k].llt().matrixL()).inverse();
      J.block(row, row, 6, 6) = Q_root;
      J.block(row, row - 6, 6, 6) = -Q_root * step.F;
      r.segment(row, 6) = Q_root * Model::difference(step.mean, x[k]);
    }
    Eigen::Index row = n;
    for (std::size_t k = 0; k < p.nodes(); ++k)
      for (std::size_t j = p.first[k]; j < p.first[k + 1]; ++j)
        p.model.linearize(p.measurements[j], x[k], [&](const auto& z) {
          for (int i = 0; i < z.innovation.rows(); ++i, ++row) {
            const double sigma = std::sqrt(z.R(i, i)), root_weight = std::sqrt(loss.weight(z.innovation(i) / sigma));
            J.block(row, static_cast<Eigen::Index>(6 * k), 1, 6) = root_weight / sigma * z.H.row(i);
            r(row) = root_weight * z.innovation(i) / sigma;
          }
        });
  }
  Dense covariance() const { return (J.transpose() * J).inverse(); }
  Eigen::VectorXd step() const { return J.householderQr().solve(r); }
};

std::vector<StateVector> meansOf(const SmootherResult& result) {
  std::vector<StateVector> means;
  for (const auto& state : result.states) means.push_back(state.mean);
  return means;
}

class EveryLoss : public ::testing::TestWithParam<LossKind> {};
std::string nameOf(const ::testing::TestParamInfo<LossKind>& info) { return lossName(info.param); }
INSTANTIATE_TEST_SUITE_P(Rts, EveryLoss,
                         ::testing::Values(LossKind::L2, LossKind::Huber, LossKind::PseudoHuber, LossKind::Cauchy),
                         nameOf);

TEST_P(EveryLoss, StopsWhereTheDenseSystemMovesNoMoreAndHasItsCovariance) {
  const Loss loss(GetParam());
  const auto problem = problemOf(testing::zhu2007(6, testing::contaminated(0.1, 10)), 1);
  const auto result = smoothRts(problem, {loss, 500, 1e-15});
  ASSERT_EQ(result.failure, "");
  const DenseSystem dense(problem, loss, meansOf(result));
  const Eigen::VectorXd step = dense.step();
  const Dense P = dense.covariance();
  for (std::size_t k = 0; k < problem.nodes(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    const StateMatrix block = P.block(at, at, 6, 6), mine = result.states[k].covariance;
    for (int i = 0; i < kStates; ++i) {
      ASSERT_LT(std::abs(step(at + i)), 1e-4 * std::sqrt(block(i, i))) << "node " << k << ", state " << i;
      for (int j = 0; j < kStates; ++j)
        ASSERT_NEAR(mine(i, j), block(i, j), 1e-6 * std::sqrt(block(i, i) * block(j, j))) << "node " << k;
    }
  }
  EXPECT_NEAR(result.cost, cost(problem, loss, meansOf(result)), 1e-9 * result.cost);
  EXPECT_LE(result.cost, cost(problem, loss, problem.initial));
}

TEST(Rts, ASurveyWithItsTurnsHasTheDenseAnswerToo) {
  auto scenario = testing::survey(12);
  scenario.line_length = 8;
  scenario.turn_rate = 25 * kRadPerDeg;
  scenario.heading = 3.1;
  scenario.source(Sensor::Position).lever_arm_body << 5, -2;
  const auto problem = problemOf(scenario, 2);
  const Loss l2(LossKind::L2);
  const auto result = smoothRts(problem, {l2, 500, 1e-15});
  const DenseSystem dense(problem, l2, meansOf(result));
  const Eigen::VectorXd step = dense.step();
  for (std::size_t k = 0; k < problem.nodes(); ++k)
    for (int i = 0; i < kStates; ++i)
      ASSERT_LT(std::abs(step(static_cast<Eigen::Index>(6 * k) + i)),
                1e-4 * std::sqrt(result.states[k].covariance(i, i)))
          << k << ", " << i;
}

TEST(Rts, TheCostOfALongRunFallsAndItConverges) {
  for (const LossKind kind : {LossKind::Huber, LossKind::Cauchy, LossKind::Tukey}) {
    const auto problem = problemOf(testing::zhu2007(60, testing::contaminated(0.2, 20)), 3);
    const auto result = smoothRts(problem, {Loss(kind), 100, 1e-9});
    EXPECT_EQ(result.failure, "") << lossName(kind);
    EXPECT_TRUE(result.converged) << lossName(kind);
    EXPECT_LT(result.cost, cost(problem, Loss(kind), problem.initial)) << lossName(kind);
    ASSERT_EQ(result.weights.size(), problem.measurements.size());
  }
}

TEST(Rts, IsNearerToTheTruthThanTheFilterItStartsFrom) {
  const auto scenario = testing::zhu2007(100, testing::contaminated(0.1, 10));
  const auto run = testing::simulate(scenario, 4);
  const auto problem = problemOf(scenario, 4);
  const auto result = smoothRts(problem, {});
  double filter = 0, smoother = 0, consistency = 0;
  for (std::size_t k = 100; k + 100 < problem.nodes(); ++k) {
    const StateVector& truth = run.truthAt(problem.stamps[k]);
    filter += (problem.initial[k] - truth).head<2>().squaredNorm();
    const Vector<2> error = (result.states[k].mean - truth).head<2>();
    smoother += error.squaredNorm();
    consistency += error.dot(result.states[k].covariance.topLeftCorner<2, 2>().inverse() * error);
  }
  EXPECT_LT(std::sqrt(smoother / filter), 0.8);
  EXPECT_LT(consistency / static_cast<double>(problem.nodes() - 200), 10);
}

TEST(Rts, WhatCannotBeSolvedIsReportedAndNotThrown) {
  auto problem = problemOf(testing::zhu2007(6), 5);
  problem.Q[20].setZero();
  const SmootherResult singular = smoothRts(problem, {});
  EXPECT_NE(singular.failure, "");
  problem = problemOf(testing::zhu2007(6), 5);
  problem.measurements[7].value(0) = std::nan("");
  EXPECT_NE(smoothRts(problem, {}).failure, "");
}

TEST(Rts, NothingToBuildFromNothing) {
  EXPECT_FALSE(buildProblem({}, Config()));
  Measurement z;
  z.stamp = 1;
  EXPECT_FALSE(buildProblem({z}, Config()));  // no heading
}

}  // namespace
}  // namespace sas_motion::towfish
