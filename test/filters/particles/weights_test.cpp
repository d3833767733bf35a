// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/particles/weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace sas_motion {
namespace {

TEST(ParticleWeights, ArePartsOfOneHoweverSmallTheLikelihoods) {
  ParticleWeights weights(3);
  EXPECT_DOUBLE_EQ(weights.effectiveSize(), 3);
  for (int step = 0; step < 100; ++step) {
    for (std::size_t i = 0; i < 3; ++i) weights.multiply(i, -1e4);
    ASSERT_TRUE(weights.normalise());
  }
  weights.multiply(0, std::log(2.0));
  ASSERT_TRUE(weights.normalise());
  EXPECT_NEAR(weights.values()[0], 0.5, 1e-12);
  EXPECT_NEAR(weights.values()[2], 0.25, 1e-12);
  EXPECT_NEAR(weights.effectiveSize(), 1 / (0.25 + 2 * 0.0625), 1e-12);
  EXPECT_EQ(weights.heaviest(), 0u);
}

TEST(ParticleWeights, TakeALikelihoodThatIsNoNumberForNone) {
  ParticleWeights weights(3);
  weights.multiply(0, std::numeric_limits<double>::quiet_NaN());
  weights.multiply(1, std::numeric_limits<double>::infinity());
  ASSERT_TRUE(weights.normalise());
  EXPECT_EQ(weights.values(), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(weights.effectiveSize(), 1);
  // and never comes back
  weights.multiply(0, 1e9);
  ASSERT_TRUE(weights.normalise());
  EXPECT_EQ(weights.values()[0], 0);
}

TEST(ParticleWeights, StartAnewWhereNoParticleExplainsAnything) {
  ParticleWeights weights(4);
  for (std::size_t i = 0; i < 4; ++i) weights.multiply(i, -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(weights.normalise());
  EXPECT_EQ(weights.values(), std::vector<double>(4, 0.25));
  EXPECT_TRUE(weights.normalise());
  EXPECT_THROW(ParticleWeights(0), std::invalid_argument);
}

TEST(SystematicResampling, CopiesEachAsOftenAsItsWeightSaysGiveOrTakeOne) {
  const std::vector<double> weights{0.1, 0, 0.55, 0.05, 0.3};
  std::vector<double> mean(5);
  constexpr int kDraws = 1000;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<std::size_t> parents(10), copies(5);
    resampleSystematically(weights, (draw + 0.5) / kDraws, parents);
    for (std::size_t i = 1; i < parents.size(); ++i) ASSERT_LE(parents[i - 1], parents[i]);
    for (const auto parent : parents) ++copies[parent];
    for (std::size_t i = 0; i < 5; ++i) {
      ASSERT_LE(std::abs(static_cast<double>(copies[i]) - 10 * weights[i]), 1);
      mean[i] += static_cast<double>(copies[i]) / kDraws;
    }
  }
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(mean[i], 10 * weights[i], 0.01);
}

TEST(SystematicResampling, NeverCopiesAParticleWithoutWeight) {
  std::vector<std::size_t> parents(7);
  for (const double uniform : {0.0, 0.5, 1 - 1e-16}) {
    resampleSystematically({0, 1, 0}, uniform, parents);
    EXPECT_EQ(parents, std::vector<std::size_t>(7, 1)) << uniform;
  }
  resampleSystematically({0.5 - 1e-17, 0.5 - 1e-17}, 1 - 1e-16, parents);  // rounding leaves the sum below one
  EXPECT_EQ(parents.back(), 1u);
}

}  // namespace
}  // namespace sas_motion
