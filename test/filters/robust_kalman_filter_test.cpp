// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/robust_kalman_filter.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

RobustKalmanFilter<6>::Options options(const Loss& loss, int iterations = 500, bool process = false) {
  return {loss, iterations, 1e-12, process};
}

/// (15), with rho1 the same loss or, without process weights, r^2 / 2.
class Objective {
 public:
  Objective(const Gaussian<6>& prior, const LinearMeasurement<6, 4>& z, const Loss& loss, bool process)
      : prior_(prior), z_(z), loss_(loss), process_(process) {
    root_ = Eigen::SelfAdjointEigenSolver<Matrix<6>>(prior.covariance).operatorInverseSqrt();
  }
  double operator()(const Vector<6>& x) const {
    const Vector<6> dx = x - prior_.mean, p = root_ * dx;
    const Vector<4> s = z_.R.llt().matrixL().solve(z_.innovation - z_.H * dx);
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += process_ ? loss_.rho(p(i)) : 0.5 * p(i) * p(i);
    for (int j = 0; j < 4; ++j) sum += loss_.rho(s(j));
    return sum;
  }
  /// With respect to P^{-1/2} x, by central differences.
  Vector<6> gradient(const Vector<6>& x) const {
    const Matrix<6> P_root = root_.inverse();
    const double h = 1e-5;
    Vector<6> g;
    for (int i = 0; i < 6; ++i) g(i) = ((*this)(x + h * P_root.col(i)) - (*this)(x - h * P_root.col(i))) / (2 * h);
    return g;
  }

 private:
  Gaussian<6> prior_;
  LinearMeasurement<6, 4> z_;
  Loss loss_;
  bool process_;
  Matrix<6> root_;
};

struct Problem {
  Gaussian<6> prior;
  LinearMeasurement<6, 4> z;
};

/// Every second row is some ten standard deviations off.
Problem contaminatedProblem(Random& random) {
  Problem problem{testing::randomBelief<6>(random), testing::randomMeasurement<6, 4>(random)};
  problem.z.innovation(1) += 10;
  problem.z.innovation(3) -= 15;
  return problem;
}

std::vector<LossKind> everyKind() {
  std::vector<LossKind> kinds;
  for (const auto& name : lossNames()) kinds.push_back(lossFromName(name));
  return kinds;
}

TEST(RobustKalmanFilter, IsTheKalmanFilterWithoutARobustLoss) {
  Random random = announced(31);
  for (int i = 0; i < 20; ++i) {
    const auto [prior, z] = contaminatedProblem(random);
    const auto kalman = KalmanFilter<6>().update(prior, z);
    for (const LossKind kind : everyKind())
      for (const bool process : {false, true}) {
        const Loss loss(kind, kind == LossKind::L2 ? 1 : 1e9);  // so wide that nothing is far
        const auto update = RobustKalmanFilter<6>(options(loss, 10, process)).update(prior, z);
        EXPECT_LT(relativeDifference(update.belief.mean, kalman.belief.mean), 1e-9) << lossName(kind);
        EXPECT_LT(relativeDifference(update.belief.covariance, kalman.belief.covariance), 1e-9) << lossName(kind);
        EXPECT_EQ(update.verdict, Verdict::Accepted) << lossName(kind);
        EXPECT_NEAR(update.nis, kalman.nis, 1e-9 * kalman.nis);
      }
  }
}

TEST(RobustKalmanFilter, OnePassIsThePapersScalarFormula) {
  Random random = announced(32);
  for (const LossKind kind : everyKind())
    for (int i = 0; i < 10; ++i) {
      const auto prior = testing::randomBelief<2>(random);
      auto z = testing::randomMeasurement<2, 1>(random);
      z.innovation(0) *= 5;
      const double r = z.R(0, 0), d = z.innovation(0), w = Loss(kind).weight(d / std::sqrt(r));
      if (w < 1e-6) continue;  // the filter keeps a least weight
      const Vector<2> Ph = prior.covariance * z.H.transpose();
      const double S = z.H.row(0).dot(Ph) + r / w;  // (19), W1 = I
      const auto update = RobustKalmanFilter<2>({Loss(kind), 1, 1e-6, false}).update(prior, z);
      EXPECT_LT(relativeDifference(update.belief.mean, prior.mean + Ph * d / S), 1e-10) << lossName(kind);
      EXPECT_LT(relativeDifference(update.belief.covariance, prior.covariance - Ph * Ph.transpose() / S), 1e-10)
          << lossName(kind);
      EXPECT_NEAR(update.weights(0), w, 1e-12) << lossName(kind);
      EXPECT_EQ(update.iterations, 1);
    }
}

TEST(RobustKalmanFilter, InOnePassTheProcessWeightsCannotAct) {
  Random random = announced(33);
  const auto [prior, z] = contaminatedProblem(random);
  const auto without = RobustKalmanFilter<6>(options(Loss(LossKind::Huber), 1, false)).update(prior, z);
  const auto with = RobustKalmanFilter<6>(options(Loss(LossKind::Huber), 1, true)).update(prior, z);
  EXPECT_EQ(with.belief.mean, without.belief.mean);
  EXPECT_EQ(with.belief.covariance, without.belief.covariance);
}

TEST(RobustKalmanFilter, ConvergedHuberIsAStationaryPointOfTheObjective) {
  Random random = announced(34);
  for (const bool process : {false, true})
    for (int i = 0; i < 20; ++i) {
      const auto [prior, z] = contaminatedProblem(random);
      const Loss huber(LossKind::Huber);
      const auto update = RobustKalmanFilter<6>(options(huber, 2000, process)).update(prior, z);
      ASSERT_TRUE(update.converged) << "process " << process << ", problem " << i;
      const Objective objective(prior, z, huber, process);
      EXPECT_LT(objective.gradient(update.belief.mean).norm(), 1e-6) << "process " << process << ", problem " << i;
      EXPECT_GT(objective.gradient(prior.mean).norm(), 1e-2);  // the prediction is none
    }
}

TEST(RobustKalmanFilter, ARedescendingAnswerIsALocalMinimumNoWorseThanItsHuberStart) {
  Random random = announced(35);
  for (const LossKind kind : everyKind()) {
    if (!Loss::redescending(kind)) continue;
    for (int i = 0; i < 10; ++i) {
      const auto [prior, z] = contaminatedProblem(random);
      const auto update = RobustKalmanFilter<6>(options(Loss(kind), 2000)).update(prior, z);
      const auto start = RobustKalmanFilter<6>(options(Loss(LossKind::Huber), 2000)).update(prior, z);
      const Objective objective(prior, z, Loss(kind), false);
      const double found = objective(update.belief.mean);
      ASSERT_TRUE(update.converged) << lossName(kind);
      EXPECT_LE(found, objective(start.belief.mean) * (1 + 1e-9)) << lossName(kind);
      EXPECT_LT(objective.gradient(update.belief.mean).norm(), 1e-5) << lossName(kind);
      for (int j = 0; j < 20; ++j)
        EXPECT_GE(objective(update.belief.mean + 1e-3 * testing::randomMatrix<6>(random).normalized()),
                  found * (1 - 1e-9))
            << lossName(kind);
    }
  }
}

TEST(RobustKalmanFilter, OneMeasurementHasBoundedInfluence) {
  Random random = announced(36);
  const auto prior = testing::randomBelief<6>(random);
  auto z = testing::randomMeasurement<6, 1>(random);
  z.innovation(0) = 1e6;
  const auto moved = [&](const Loss& loss, int iterations) {
    return (RobustKalmanFilter<6>(options(loss, iterations)).update(prior, z).belief.mean - prior.mean).norm();
  };
  const Loss huber(LossKind::Huber);
  const double bound =
      (prior.covariance * z.H.transpose()).norm() * huber.tuning() / std::sqrt(z.R(0, 0));  // |P h| psi_max / sigma
  EXPECT_GT(moved(Loss(LossKind::L2), 1), 1e3 * bound);
  EXPECT_LE(moved(huber, 1), bound);
  EXPECT_NEAR(moved(huber, 100), bound, 1e-3 * bound);
  for (const LossKind kind : everyKind()) {
    if (!Loss::redescending(kind)) continue;
    EXPECT_LT(moved(Loss(kind), 100), 1e-2 * bound) << lossName(kind);
  }
}

TEST(RobustKalmanFilter, WithProcessWeightsAJumpThatAllRowsSeeIsBelieved) {
  const Gaussian<6> prior;
  LinearMeasurement<6, 4> z;
  z.H.setZero();
  z.H.col(0).setOnes();
  z.R.setIdentity();
  z.innovation.setConstant(20);
  EXPECT_LT(RobustKalmanFilter<6>(options(Loss(LossKind::Huber))).update(prior, z).belief.mean(0), 6);
  EXPECT_GT(RobustKalmanFilter<6>(options(Loss(LossKind::Huber), 500, true)).update(prior, z).belief.mean(0), 18);
}

TEST(RobustKalmanFilter, RefusesBadOptions) {
  EXPECT_THROW(RobustKalmanFilter<6>(options(Loss(LossKind::Huber), 0)), std::invalid_argument);
  EXPECT_THROW(RobustKalmanFilter<6>({Loss(LossKind::Huber), 5, 0.0, false}), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion
