// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/ensemble.hpp"

#include <cmath>

#include "sas_motion/math/statistics.hpp"
#include "support.hpp"

namespace sas_motion::towfish {
namespace {

constexpr int kDegrees = 6;

/// NEES of runs whose errors are `spread` times what their covariance says and stay the same for about 20 samples.
std::vector<std::vector<double>> correlatedRuns(int runs, int times, double spread) {
  std::vector<std::vector<double>> all;
  for (int i = 0; i < runs; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    const double keep = std::exp(-1.0 / 20), drive = std::sqrt(1 - keep * keep);
    Vector<kDegrees> error = testing::randomMatrix<kDegrees>(random);
    auto& run = all.emplace_back();
    for (int k = 0; k < times; ++k) {
      error = keep * error + drive * testing::randomMatrix<kDegrees>(random);
      run.push_back(spread * spread * error.squaredNorm());
    }
  }
  return all;
}

std::vector<double> meansOf(const std::vector<std::vector<double>>& runs) {
  std::vector<double> means;
  for (const auto& run : runs) means.push_back(mean(run));
  return means;
}

TEST(Ensemble, RightCovariancesLieInTheBandThoughErrorsAreCorrelated) {
  const auto runs = correlatedRuns(100, 2000, 1);
  const auto result = ensembleConsistency(runs, kDegrees);
  EXPECT_EQ(result.times, 2000u);
  EXPECT_NEAR(result.inside, 0.95, 0.04);  // about 200 independent times: 0.015 is one sigma
  EXPECT_LT(result.band.lower, kDegrees);
  EXPECT_GT(result.band.upper, kDegrees);
  const auto means = meansOf(runs);
  EXPECT_LT(std::abs(mean(means) - kDegrees), 3 * standardError(means));
  // As if samples were independent the mean would seem far better known: sqrt(2 * 6 / 200000) = 0.008.
  EXPECT_GT(standardError(means), 2.5 * std::sqrt(2.0 * kDegrees / 200000));
}

TEST(Ensemble, WrongCovariancesDoNot) {
  for (const double spread : {0.9, 1.1}) {
    const auto runs = correlatedRuns(100, 500, spread);
    EXPECT_LT(ensembleConsistency(runs, kDegrees).inside, 0.6) << spread;
    EXPECT_GT(std::abs(mean(meansOf(runs)) - kDegrees), 5 * standardError(meansOf(runs))) << spread;
  }
}

TEST(Ensemble, TimesThatARunLacksAreLeftOut) {
  auto runs = correlatedRuns(3, 10, 1);
  runs[1][4] = NAN;
  runs[2].resize(8);
  EXPECT_EQ(ensembleConsistency(runs, kDegrees).times, 7u);
  EXPECT_EQ(ensembleConsistency({}, kDegrees).times, 0u);
  EXPECT_EQ(ensembleConsistency({{NAN, NAN}}, kDegrees).inside, 0);
}

}  // namespace
}  // namespace sas_motion::towfish
