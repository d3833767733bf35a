// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/simulation/noise_law.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

constexpr int kDraws = 200000;

TEST(NoiseLaw, ContaminatedHasItsShareOfOutliersAndTheirVariance) {
  for (const auto& [epsilon, K] : {std::pair{0.1, 10.0}, {0.4, 100.0}}) {
    NoiseSource source(testing::contaminated(epsilon, K), 1, 2);
    std::cout << "seed 1, stream 2\n";
    int outliers = 0;
    double good = 0, bad = 0;
    for (int i = 0; i < kDraws; ++i) {
      const auto sample = source.draw(0.1 * i);
      outliers += sample.outlier;
      (sample.outlier ? bad : good) += sample.value * sample.value;
    }
    EXPECT_NEAR(outliers / double(kDraws), epsilon, 5 * std::sqrt(epsilon * (1 - epsilon) / kDraws));
    EXPECT_NEAR(good / (kDraws - outliers), 1, 5 * std::sqrt(2.0 / (kDraws - outliers)));
    EXPECT_NEAR(bad / outliers / (K * K), 1, 5 * std::sqrt(2.0 / outliers));
  }
}

TEST(NoiseLaw, ContaminationLeavesTheGoodDrawsAsTheyWere) {
  NoiseSource plain({}, 3, 4), mixed(testing::contaminated(0.3, 20), 3, 4);
  int outliers = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto a = plain.draw(i), b = mixed.draw(i);
    EXPECT_FALSE(a.outlier);
    EXPECT_DOUBLE_EQ(b.value, b.outlier ? 20 * a.value : a.value);
    outliers += b.outlier;
  }
  EXPECT_GT(outliers, 200);
}

TEST(NoiseLaw, BurstsComeAtTheirRateLastTheirLengthAndAreBiased) {
  const NoiseLaw law{NoiseLaw::Kind::Burst, 0, 20, 0.02, 3};
  NoiseSource source(law, 5, 6);
  std::cout << "seed 5, stream 6\n";
  const double step = 0.1;
  int bursts = 0, biased = 0, length = 0;
  bool before = false;
  double sum = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto sample = source.draw(i * step);
    if (sample.outlier && !before) {
      ++bursts;
      length = 0;
    }
    length += sample.outlier;
    if (!sample.outlier && before) {
      EXPECT_GE(length, 29);  // two that touch count as one
    }
    if (sample.outlier) {
      ++biased;
      sum += sample.value;
    }
    before = sample.outlier;
  }
  const double expected = kDraws * step / (1 / law.rate + law.length);  // quiet spells last 1 / rate
  EXPECT_NEAR(bursts, expected, 5 * std::sqrt(expected));
  EXPECT_NEAR(sum / biased, 20, 5 / std::sqrt(biased));
}

TEST(NoiseLaw, ReadsItselfAndSaysItsName) {
  const auto law = NoiseLaw::read(YamlSection::fromText("{law: contaminated, epsilon: 0.1, K: 10}", "inline"));
  EXPECT_EQ(law.name(), "contaminated(0.1,10)");
  EXPECT_EQ(NoiseLaw().name(), "gaussian");
  EXPECT_THROW(NoiseLaw::read(YamlSection::fromText("{law: cauchy}", "inline")), ConfigError);
  EXPECT_THROW(NoiseLaw::read(YamlSection::fromText("{law: contaminated, epsilon: 1.1}", "inline")), ConfigError);
  EXPECT_THROW(NoiseLaw::read(YamlSection::fromText("{law: gaussian, K: 3}", "inline")), ConfigError);  // not used, so not silent
}

}  // namespace
}  // namespace sas_motion
