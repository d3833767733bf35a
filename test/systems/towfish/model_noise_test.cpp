// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "sas_motion/systems/towfish/model.hpp"
#include "support.hpp"

namespace sas_motion::towfish {
namespace {

using testing::announced;

StateVector someState(Random& random) {
  StateVector x;
  x << 0, 0, 0.2, 0.1, kPi * (2 * random.uniform() - 1), 1 + 2 * random.uniform();
  return x;
}

struct Continuous {
  StateMatrix A = StateMatrix::Zero(), q = StateMatrix::Zero();
  Continuous(const MotionParameters& p, double heading, double speed) {
    A(0, 2) = A(1, 3) = 1;
    A(2, 2) = A(3, 3) = -1 / p.current_time_constant;
    A(0, 4) = -speed * std::sin(heading);
    A(1, 4) = speed * std::cos(heading);
    A(0, 5) = std::cos(heading);
    A(1, 5) = std::sin(heading);
    q(0, 0) = q(1, 1) = p.position_noise * p.position_noise;
    q(2, 2) = q(3, 3) = 2 * p.current_sigma * p.current_sigma / p.current_time_constant;
    q(4, 4) = p.heading_noise * p.heading_noise;
    q(5, 5) = p.speed_noise * p.speed_noise;
  }
  /// F and Q by the exponential of a matrix twice as large. [VanLoan1978]
  std::pair<StateMatrix, StateMatrix> discrete(double T) const {
    Matrix<12> M = Matrix<12>::Zero();
    M.topLeftCorner<6, 6>() = -A;
    M.topRightCorner<6, 6>() = q;
    M.bottomRightCorner<6, 6>() = A.transpose();
    const Matrix<12> E = (M * T).exp();
    const StateMatrix F = E.bottomRightCorner<6, 6>().transpose();
    return {F, F * E.topRightCorner<6, 6>()};
  }
};

TEST(TowfishNoise, IsVanLoansIntegral) {
  Random random = announced(91);
  MotionParameters p;
  p.current_time_constant = 60;
  const Model model(p);
  for (const double T :
       {0.003, 0.03, 0.059, 0.061, 0.6, 1.0, 10.0, 100.0}) {  // the series for the current ends at 0.06 s
    const StateVector x = someState(random);
    const auto step = model.transition(x, {}, T);
    const auto [F, Q] = Continuous(p, x(kHeading), x(kSpeed)).discrete(T);
    EXPECT_LT(testing::relativeDifference(step.F, F), 1e-11) << T;
    for (int row = 0; row < kStates; ++row)
      for (int col = 0; col < kStates; ++col)  // against the size that the two states' variances allow
        EXPECT_NEAR(step.Q(row, col), Q(row, col), 1e-9 * std::sqrt(Q(row, row) * Q(col, col)))
            << T << " s, " << row << ", " << col;
  }
}

TEST(TowfishNoise, TwoStepsAddUpToOneOfTwiceTheLength) {
  Random random = announced(92);
  const Model model{MotionParameters()};
  for (const double T : {1e-3, 0.1, 3.0, 5.9, 50.0}) {
    const StateVector x = someState(random);
    const auto one = model.transition(x, {}, T), two = model.transition(x, {}, 2 * T);
    const StateMatrix sum = one.F * one.Q * one.F.transpose() + one.Q;  // without a turn rate F does not change
    for (int i = 0; i < kStates; ++i)
      for (int j = 0; j < kStates; ++j)
        EXPECT_NEAR(two.Q(i, j), sum(i, j), 1e-8 * std::sqrt(sum(i, i) * sum(j, j))) << T << " s, " << i << ", " << j;
  }
}

TEST(TowfishNoise, IsPositiveDefiniteFromAMillisecondToMinutes) {
  Random random = announced(93);
  MotionParameters slow;
  slow.current_time_constant = 1e6;
  for (const auto& p : {MotionParameters(), slow})
    for (double T = 1e-3; T < 101; T *= 1.3) {
      const auto Q = Model(p).transition(someState(random), {0.05}, T).Q;
      EXPECT_EQ(Q, StateMatrix(Q.transpose()));
      const StateVector sigma = Q.diagonal().cwiseSqrt();
      const StateMatrix correlation = sigma.cwiseInverse().asDiagonal() * Q * sigma.cwiseInverse().asDiagonal();
      EXPECT_GT(testing::smallestEigenvalue<kStates>(correlation), 0) << T;
      EXPECT_EQ(Eigen::LLT<StateMatrix>(Q).info(), Eigen::Success) << T;
    }
}

TEST(TowfishNoise, NoTimeNoNoise) {
  Random random = announced(94);
  const StateVector x = someState(random);
  const auto step = Model{MotionParameters()}.transition(x, {0.1}, 0);
  EXPECT_EQ(step.mean, x);
  EXPECT_EQ(step.F, StateMatrix(StateMatrix::Identity()));
  EXPECT_EQ(step.Q, StateMatrix(StateMatrix::Zero()));
}

TEST(TowfishNoise, CurrentForgetsToItsOwnStandardDeviation) {  // R(tau) = sigma^2 exp(-beta tau), (2)
  const MotionParameters p;
  const auto step = Model(p).transition(StateVector::Zero(), {}, 20 * p.current_time_constant);
  EXPECT_NEAR(step.Q(kCurrentNorth, kCurrentNorth), p.current_sigma * p.current_sigma, 1e-12);
  const auto half = Model(p).transition(StateVector::Zero(), {}, p.current_time_constant);
  EXPECT_NEAR(half.F(kCurrentEast, kCurrentEast), std::exp(-1.0), 1e-12);
}

}  // namespace
}  // namespace sas_motion::towfish
