// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sas_motion/noise/noise_source.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

constexpr int kSteps = 50000;

TEST(ProcessNoise, EachStateHasDrawsOfItsOwnWithoutAnEpoch) {
  ProcessNoise noise(testing::contaminated(0.1, 10), 6, 1, 100);
  std::vector<NoiseSource> sources;
  for (std::uint64_t i = 0; i < 6; ++i) sources.emplace_back(testing::contaminated(0.1, 10), 1, 100 + i);
  for (int step = 1; step < 1000; ++step) {
    const auto draw = noise.draw(0.1 * step);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto sample = sources[static_cast<std::size_t>(i)].draw(0.1 * step);
      ASSERT_EQ(draw.value(i), sample.value);
      ASSERT_EQ(draw.variance(i), sample.variance);
    }
  }
}

TEST(ProcessNoise, AContaminatedEpochHoldsForAllStatesUntilItsEnd) {
  NoiseLaw law = testing::contaminated(0.05, 10);
  law.epoch = 0.5;
  ProcessNoise noise(law, 6, 2, 100), plain({}, 6, 2, 100);
  std::cout << "seed 2\n";
  int large = 0;
  double scale = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const auto draw = noise.draw(0.1 * step), good = plain.draw(0.1 * step);
    if (step % 5 == 1) {  // (0, 0.5], (0.5, 1], ...
      scale = draw.variance(0);
      large += scale > 1;
    }
    ASSERT_EQ(draw.variance, Eigen::VectorXd::Constant(6, scale)) << step;
    ASSERT_EQ(draw.value, Eigen::VectorXd(std::sqrt(scale) * good.value)) << step;
  }
  EXPECT_NEAR(large / (kSteps / 5.0), 0.05, 5 * std::sqrt(0.0475 / (kSteps / 5.0)));
}

TEST(ProcessNoise, ManoeuvresMakeAllNoiseLargerForTheirLength) {
  NoiseLaw law;
  law.kind = NoiseLaw::Kind::Manoeuvre;
  law.rate = 0.02;
  law.length = 3;
  law.K = 10;
  ProcessNoise noise(law, 6, 3, 100);
  std::cout << "seed 3\n";
  double squares = 0;
  int on = 0, spells = 0;
  bool before = false;
  for (int step = 1; step <= kSteps; ++step) {
    const auto draw = noise.draw(0.1 * step);
    const bool now = draw.variance(0) > 1;
    ASSERT_EQ(draw.variance, Eigen::VectorXd::Constant(6, now ? 100 : 1));
    squares += draw.value.squaredNorm() / draw.variance(0);
    on += now;
    spells += now && !before;
    before = now;
  }
  EXPECT_NEAR(squares / (6 * kSteps), 1, 5 * std::sqrt(2.0 / (6 * kSteps)));
  const double expected = 0.1 * kSteps / (1 / law.rate + law.length);
  EXPECT_NEAR(spells, expected, 5 * std::sqrt(expected));
  EXPECT_NEAR(on / (30.0 * spells), 1, 0.1);
}

TEST(ProcessNoise, AnOracleMakesOfTheToldVariancesTheCovarianceOfTheDraw) {
  Random random = testing::announced(4);
  const Matrix<6> Q = testing::randomCovariance<6>(random);
  EXPECT_LT(testing::relativeDifference(covarianceWith<6>(Q, Vector<6>::Constant(100)), 100 * Q), 1e-14);
  const Vector<6> variance = (Vector<6>() << 1, 100, 1, 1, 4, 0.25).finished();
  Matrix<6> sample = Matrix<6>::Zero();
  const Matrix<6> L = Q.llt().matrixL();
  for (int i = 0; i < kSteps; ++i) {
    const Vector<6> drawn = L * testing::randomMatrix<6>(random).cwiseProduct(variance.cwiseSqrt());
    sample += drawn * drawn.transpose() / kSteps;
  }
  EXPECT_LT(testing::relativeDifference(covarianceWith<6>(Q, variance), sample), 0.03);
}

TEST(ProcessNoise, HasRoomForSixStates) {
  EXPECT_EQ(ProcessNoise({}, ProcessNoise::kMostStates, 1, 100).draw(1).value.size(), 6);
  EXPECT_THROW(ProcessNoise({}, ProcessNoise::kMostStates + 1, 1, 100), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion
