// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/noise_source.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

constexpr int kDraws = 200000;

TEST(NoiseSource, ContaminatedHasItsShareOfOutliersAndTheirVariance) {
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

TEST(NoiseSource, ContaminationLeavesTheGoodDrawsAsTheyWere) {
  NoiseSource plain({}, 3, 4), mixed(testing::contaminated(0.3, 20), 3, 4);
  int outliers = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto a = plain.draw(i), b = mixed.draw(i);
    EXPECT_FALSE(a.outlier);
    EXPECT_DOUBLE_EQ(b.value, b.outlier ? 20 * a.value : a.value);
    EXPECT_DOUBLE_EQ(b.variance, b.outlier ? 400 : 1);
    outliers += b.outlier;
  }
  EXPECT_GT(outliers, 200);
}

TEST(NoiseSource, BurstsComeAtTheirRateLastTheirLengthAndAreBiased) {
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

NoiseLaw law(NoiseLaw::Kind kind, const std::vector<std::pair<double NoiseLaw::*, double>>& values) {
  NoiseLaw result;
  result.kind = kind;
  for (const auto& [member, value] : values) result.*member = value;
  return result;
}

/// Draws at 10 Hz.
std::vector<NoiseSample> draws(const NoiseMix& mix, int count = kDraws) {
  std::cout << "seed 7, stream 8\n";
  NoiseSource source(mix, 7, 8);
  std::vector<NoiseSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back(source.draw(0.1 * i));
  return samples;
}

template <class What>
double average(const std::vector<NoiseSample>& samples, What&& what) {
  double sum = 0;
  for (const auto& sample : samples) sum += what(sample);
  return sum / static_cast<double>(samples.size());
}

const auto square = [](const NoiseSample& s) { return s.value * s.value; };

TEST(NoiseSource, StudentsTHasItsVarianceAndTheToldVarianceWhitensIt) {
  const auto samples = draws(law(NoiseLaw::Kind::StudentT, {{&NoiseLaw::nu, 5}}));
  EXPECT_NEAR(average(samples, square), 5.0 / 3, 0.05);
  EXPECT_NEAR(average(samples, [](const auto& s) { return s.value * s.value / s.variance; }), 1,
              5 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(average(samples, [](const auto& s) { return s.variance; }), 5.0 / 3, 0.05);
  EXPECT_NEAR(average(samples, [](const auto& s) { return std::abs(s.value) < 2.5706; }), 0.95,
              5 * std::sqrt(0.0475 / kDraws));  // of its table
  for (const auto& s : samples) ASSERT_EQ(s.outlier, s.variance > 9);
}

TEST(NoiseSource, StepsAndRampsAreBiasedBetweenTheirTimesOnly) {
  const auto plain = draws({}, 1000);
  const auto step =
      draws(law(NoiseLaw::Kind::Step, {{&NoiseLaw::bias, -3}, {&NoiseLaw::t0, 20.05}, {&NoiseLaw::t1, 40.05}}), 1000);
  const auto ramp = draws(law(NoiseLaw::Kind::Ramp, {{&NoiseLaw::slope, 2}, {&NoiseLaw::t0, 60.05}}), 1000);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double time = 0.1 * static_cast<double>(i);
    const bool stepped = i > 200 && i <= 400, ramped = i > 600;
    EXPECT_NEAR(step[i].value - plain[i].value, stepped ? -3 : 0, 1e-12);
    EXPECT_NEAR(ramp[i].value - plain[i].value, ramped ? 2 * (time - 60.05) : 0, 1e-9);
    EXPECT_EQ(step[i].outlier, stepped);
    EXPECT_EQ(ramp[i].variance, ramped ? kNoInformation : 1);
  }
}

TEST(NoiseSource, SpellsOfFrozenAndMissingReadingsTakeTheirShareOfTheTime) {
  const std::vector<std::pair<double NoiseLaw::*, double>> spells{{&NoiseLaw::rate, 0.1}, {&NoiseLaw::length, 5}};
  const double share = 5 / 15.05, tolerance = 5 * share / std::sqrt(kDraws * 0.1 / 15);  // about as many spells
  const auto frozen = draws(law(NoiseLaw::Kind::Frozen, spells));
  EXPECT_NEAR(average(frozen, [](const auto& s) { return s.frozen; }), share, tolerance);
  for (const auto& s : frozen) ASSERT_EQ(s.frozen, s.outlier);
  EXPECT_NEAR(average(draws(law(NoiseLaw::Kind::Dropout, spells)), [](const auto& s) { return s.missing; }), share,
              tolerance);
  const auto some = draws(law(NoiseLaw::Kind::Dropout, {{&NoiseLaw::probability, 0.2}}));
  EXPECT_NEAR(average(some, [](const auto& s) { return s.missing; }), 0.2, 5 * std::sqrt(0.16 / kDraws));
}

TEST(NoiseSource, MultipathOnlyMakesLonger) {
  const auto plain = draws({});
  const auto samples = draws(law(NoiseLaw::Kind::Multipath, {{&NoiseLaw::probability, 0.1}, {&NoiseLaw::mean, 20}}));
  double excess = 0, count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].outlier) continue;
    ASSERT_GE(samples[i].value, plain[i].value);
    ASSERT_EQ(samples[i].variance, kNoInformation);
    excess += samples[i].value - plain[i].value;
    ++count;
  }
  EXPECT_NEAR(count / kDraws, 0.1, 5 * std::sqrt(0.09 / kDraws));
  EXPECT_NEAR(excess / count, 20, 5 * 20 / std::sqrt(count));
}

TEST(NoiseSource, CorrelatedNoiseKeepsItsVarianceAndForgetsByItsTimeConstant) {
  const auto samples =
      draws(law(NoiseLaw::Kind::Correlated, {{&NoiseLaw::time_constant, 2}, {&NoiseLaw::share, 0.75}}));
  const double tolerance = 5 * std::sqrt(2 * 20.0 / kDraws);  // as if every twentieth were independent
  EXPECT_NEAR(average(samples, square), 1, tolerance);
  for (const std::size_t lag : {1u, 10u, 40u}) {
    double sum = 0;
    for (std::size_t i = lag; i < samples.size(); ++i) sum += samples[i].value * samples[i - lag].value;
    EXPECT_NEAR(sum / kDraws, 0.75 * std::exp(-0.1 * static_cast<double>(lag) / 2), tolerance) << lag;
  }
}

TEST(NoiseSource, VaryingNoiseSwingsBetweenOneAndItsFactor) {
  const auto samples = draws(law(NoiseLaw::Kind::Varying, {{&NoiseLaw::period, 10}, {&NoiseLaw::factor, 4}}));
  EXPECT_DOUBLE_EQ(samples[0].variance, 1);
  EXPECT_NEAR(samples[50].variance, 16, 1e-9);
  EXPECT_NEAR(samples[25].variance, 2.5 * 2.5, 1e-9);
  EXPECT_NEAR(average(samples, [](const auto& s) { return s.value * s.value / s.variance; }), 1,
              5 * std::sqrt(2.0 / kDraws));
}

TEST(NoiseSource, LawsInAListActInTheirOrderAndDrawTheirOwnNumbers) {
  const auto bad = testing::contaminated(0.1, 10);
  const auto bias = law(NoiseLaw::Kind::Step, {{&NoiseLaw::bias, 5}});
  const auto round = law(NoiseLaw::Kind::Quantised, {{&NoiseLaw::quantum, 0.5}});
  const auto alone = draws(bad, 1000), mixed = draws(std::vector<NoiseLaw>{bad, bias, round}, 1000);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_DOUBLE_EQ(mixed[i].value, alone[i].value + 5);
    EXPECT_DOUBLE_EQ(mixed[i].quantum, 0.5);
  }
  const auto twice = draws(std::vector<NoiseLaw>{bad, bad});
  EXPECT_NEAR(average(twice, [](const auto& s) { return s.variance == 1e4; }), 0.01,
              5 * std::sqrt(0.01 / kDraws));  // independent of each other
}

}  // namespace
}  // namespace sas_motion
