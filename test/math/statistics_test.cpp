// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/statistics.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

TEST(ChiSquared, QuantilesAreThePublishedOnes) {  // NIST/SEMATECH e-Handbook of Statistical Methods, table 1.3.6.7.4
  EXPECT_NEAR(chiSquaredQuantile(0.95, 1), 3.841, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.99, 1), 6.635, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.95, 2), 5.991, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.99, 2), 9.210, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.95, 6), 12.592, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.99, 6), 16.812, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.05, 6), 1.635, 5e-4);
  EXPECT_NEAR(chiSquaredQuantile(0.975, 100), 129.561, 5e-4);
}

TEST(ChiSquared, TheBandOfAnAverageHoldsItsShare) {
  Random random = testing::announced(2);
  const int degrees = 3, count = 50, trials = 4000;
  const Band band = averageChiSquaredBand(degrees, count, 0.95);
  EXPECT_LT(band.lower, degrees);
  EXPECT_GT(band.upper, degrees);
  int inside = 0;
  for (int trial = 0; trial < trials; ++trial) {
    double sum = 0;
    for (int i = 0; i < degrees * count; ++i) sum += std::pow(random.gaussian(), 2);
    inside += sum / count > band.lower && sum / count < band.upper;
  }
  EXPECT_NEAR(inside / double(trials), 0.95, 4 * std::sqrt(0.95 * 0.05 / trials));
}

TEST(Statistics, MeanAndRootMeanSquare) {
  EXPECT_EQ(mean({1, 2, 6}), 3);
  EXPECT_NEAR(rootMeanSquare({3, -4, 0, 0}), 2.5, 1e-15);
  EXPECT_EQ(mean({}), 0);
  EXPECT_EQ(rootMeanSquare({}), 0);
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  const std::vector<double> values{40, 10, 30, 20};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 1), 40);
  EXPECT_NEAR(quantile(values, 0.5), 25, 1e-12);
  EXPECT_NEAR(quantile(values, 0.95), 38.5, 1e-12);
  EXPECT_EQ(quantile({7}, 0.3), 7);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(Statistics, TheStandardErrorIsTheSpreadOfMeans) {
  EXPECT_EQ(standardError({}), 0);
  EXPECT_EQ(standardError({3}), 0);
  EXPECT_NEAR(standardError({1, 2, 3, 4}), std::sqrt(5.0 / 3 / 4), 1e-15);
}

}  // namespace
}  // namespace sas_motion
