// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/random.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

std::vector<double> draws(Random random, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(random.gaussian());
  return values;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return ab / std::sqrt(aa * bb);
}

TEST(Random, TheSameSeedGivesTheSameNumbers) { EXPECT_EQ(draws(Random(7, 3), 1000), draws(Random(7, 3), 1000)); }

TEST(Random, SeedsAndStreamsAreIndependent) {
  const int count = 20000;
  const double bound = 5 / std::sqrt(double(count));
  for (std::uint64_t stream = 0; stream < 5; ++stream)
    for (std::uint64_t other = 0; other < stream; ++other) {
      EXPECT_LT(std::abs(correlation(draws(Random(1, stream), count), draws(Random(1, other), count))), bound)
          << stream << " " << other;
      EXPECT_LT(std::abs(correlation(draws(Random(stream, 1), count), draws(Random(other, 1), count))), bound)
          << stream << " " << other;
      EXPECT_LT(std::abs(correlation(draws(Random(stream, other), count), draws(Random(other, stream), count))), bound)
          << stream << " " << other;
    }
}

TEST(Random, GaussianHasUnitVarianceAndUniformItsMoments) {
  Random random = testing::announced(3);
  const int count = 100000;
  double sum = 0, squares = 0, fourth = 0, uniform = 0;
  int heads = 0;
  for (int i = 0; i < count; ++i) {
    const double g = random.gaussian();
    sum += g;
    squares += g * g;
    fourth += g * g * g * g;
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    uniform += u;
    heads += random.bernoulli(0.3);
  }
  EXPECT_NEAR(sum / count, 0, 5 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2.0 / count));
  EXPECT_NEAR(fourth / count, 3, 5 * std::sqrt(96.0 / count));
  EXPECT_NEAR(uniform / count, 0.5, 5 / std::sqrt(12.0 * count));
  EXPECT_NEAR(heads / double(count), 0.3, 5 * std::sqrt(0.21 / count));
}

}  // namespace
}  // namespace sas_motion
