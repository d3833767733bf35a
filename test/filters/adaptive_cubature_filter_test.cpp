// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/adaptive_cubature_filter.hpp"

#include <vector>

#include "sas_motion/math/statistics.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

constexpr int kN = 2, kM = 2;
using Filter = AdaptiveCubatureFilter<kN, kM>;
using Belief = Filter::Belief;

/// A curved h: range and bearing of a fixed point.
Vector<kM> rangeAndBearing(const Vector<kN>& x) { return {x.norm(), std::atan2(x(1), x(0))}; }
const Vector<kN> kTruth(30, 20);
const Gaussian<kN> kPrior{Vector<kN>(31, 18), 4 * Matrix<kN>::Identity()};
const Vector<kM> kVariance(0.25, 1e-4), kPresent(1, 1);

Vector<kM> reading(Random& random, double factor = 1) {
  return rangeAndBearing(kTruth) + Vector<kM>(std::sqrt(factor * kVariance(0)) * random.gaussian(),
                                              std::sqrt(factor * kVariance(1)) * random.gaussian());
}

Update<Belief, kM> updated(const AdaptiveCubatureOptions& options, const Belief& prior, const Vector<kM>& z,
                           const Vector<kM>& present = kPresent) {
  return Filter(options).update(prior, z, kVariance, present, rangeAndBearing, PlainDifference());
}

AdaptiveCubatureOptions huber(double tuning = 1.345) {
  AdaptiveCubatureOptions options;
  options.loss = Loss(LossKind::Huber, tuning);
  return options;
}

TEST(AdaptiveCubatureFilter, WithNeitherPartIsTheCubatureKalmanFilter) {
  Random random = testing::announced(1);
  const Vector<kM> z = reading(random);
  const auto ours = updated({}, Belief(kPrior), z);
  const auto ckf = CubatureKalmanFilter<kN>(cubaturePoints<kN>())
                       .update<kM>(kPrior, z, rangeAndBearing, Matrix<kM>(kVariance.asDiagonal()));
  EXPECT_LT((ours.belief.state.mean - ckf.belief.mean).norm(), 1e-13);
  EXPECT_LT((ours.belief.state.covariance - ckf.belief.covariance).norm(), 1e-13);
  EXPECT_NEAR(ours.nis, ckf.nis, 1e-12);
}

TEST(AdaptiveCubatureFilter, AWideHuberLossChangesNothing) {
  Random random = testing::announced(2);
  const Vector<kM> z = reading(random);
  EXPECT_LT(
      (updated(huber(1e9), Belief(kPrior), z).belief.state.mean - updated({}, Belief(kPrior), z).belief.state.mean)
          .norm(),
      1e-12);
}

TEST(AdaptiveCubatureFilter, CertainNoiseStaysAsItIs) {
  Random random = testing::announced(3);
  AdaptiveCubatureOptions adaptive;
  adaptive.adaptive = true;
  adaptive.rho = 1;
  adaptive.trend = 0;
  Belief prior(kPrior);
  prior.noise = VariationalNoise<kM>(Vector<kM>::Ones(), 1e12);
  const Vector<kM> z = reading(random);
  EXPECT_LT((updated(adaptive, prior, z).belief.state.mean - updated({}, Belief(kPrior), z).belief.state.mean).norm(),
            1e-9);
}

TEST(AdaptiveCubatureFilter, BothWaysOfReweightingMeetAtTheFixedPoint) {
  Random random = testing::announced(4);
  Vector<kM> z = reading(random);
  z(0) += 8;
  auto by_covariance = huber(), by_observation = huber();
  by_observation.reweighting = Reweighting::Observation;
  by_covariance.iterations = by_observation.iterations = 1;
  const auto once = (updated(by_covariance, Belief(kPrior), z).belief.state.mean -
                     updated(by_observation, Belief(kPrior), z).belief.state.mean)
                        .norm();
  by_covariance.iterations = by_observation.iterations = 200;
  const auto converged = (updated(by_covariance, Belief(kPrior), z).belief.state.mean -
                          updated(by_observation, Belief(kPrior), z).belief.state.mean)
                             .norm();
  EXPECT_GT(once, 1e-3);
  EXPECT_LT(converged, 1e-6);
}

TEST(AdaptiveCubatureFilter, AnAbsentRowDoesNotCountWhateverItsValue) {
  Random random = testing::announced(5);
  Vector<kM> z = reading(random), other = z;
  other(1) += 100;
  auto options = huber();
  options.adaptive = options.calibrate = true;
  const Vector<kM> range_alone(1, 0);
  const auto a = updated(options, Belief(kPrior), z, range_alone),
             b = updated(options, Belief(kPrior), other, range_alone);
  EXPECT_EQ(a.belief.state.mean, b.belief.state.mean);
  EXPECT_EQ(a.belief.state.covariance, b.belief.state.covariance);
  EXPECT_EQ(a.belief.noise.factor(0)(1), 1);
  EXPECT_LT(a.belief.state.covariance.determinant(), kPrior.covariance.determinant()) << "the row that is there counts";
}

/// Mean over the last readings of many of the noise estimate, of good noise `factor` times the stated variance with a
/// share of outliers.
Vector<kM> learnt(AdaptiveCubatureOptions options, double factor, double outliers) {
  Random random(6);
  options.adaptive = true;
  options.rho = 0.99;
  options.trend = 0;
  const Filter filter(options);
  Belief belief(kPrior);
  Vector<kM> sum = Vector<kM>::Zero();
  constexpr int kReadings = 6000, kLast = 5000;
  for (int k = 0; k < kReadings; ++k) {
    const Vector<kM> z = reading(random, factor * (random.bernoulli(outliers) ? 100 : 1));
    belief = filter.update(belief, z, kVariance, kPresent, rangeAndBearing, PlainDifference()).belief;
    if (k >= kReadings - kLast) sum += belief.noise.factor(0) / kLast;
  }
  return sum;
}

TEST(AdaptiveCubatureFilter, LearnsTheScaleOfTheNoise) {
  for (const double factor : {0.04, 1.0, 25.0})
    for (int row = 0; row < kM; ++row) {
      EXPECT_NEAR(learnt({}, factor, 0)(row) / factor, 1, 0.06);
      EXPECT_NEAR(learnt(huber(), factor, 0)(row) / factor, 0.96, 0.06)
          << "the mixture takes a little of good noise for bad";
    }
}

TEST(AdaptiveCubatureFilter, UnderOutliersEachIncrementLearnsWhatTheoryHasOfIt) {
  // standard deviation over the good one's, one reading in ten ten times too wide
  const std::vector<std::pair<NoiseIncrement, double>> expected{{NoiseIncrement::Raw, 3.30},
                                                                {NoiseIncrement::Weighted, 1.61},
                                                                {NoiseIncrement::Pseudo, 0.757},
                                                                {NoiseIncrement::Consistent, 1.147},
                                                                {NoiseIncrement::Mixture, 1.0}};
  for (const auto& [increment, sigma] : expected) {
    auto options = huber();
    options.increment = increment;
    options.clamp = 1e4;
    EXPECT_NEAR(std::sqrt(learnt(options, 1, 0.1).mean()) / sigma, 1, 0.08) << static_cast<int>(increment);
  }
}

TEST(AdaptiveCubatureFilter, TheTrendTakesBackTheLateness) {
  const auto lateness = [](double trend) {
    Random random(7);
    auto options = huber();
    options.adaptive = true;
    options.trend = trend;
    const Filter filter(options);
    Belief belief(kPrior);
    double sum = 0;
    constexpr int kReadings = 300;
    for (int k = 0; k < kReadings; ++k) {
      const double factor = std::exp(0.011 * k);
      belief = filter.update(belief, reading(random, factor), kVariance, kPresent, rangeAndBearing, PlainDifference())
                   .belief;
      if (k >= 100) sum += std::log(belief.noise.factor(trend).prod() / (factor * factor)) / 2 / (kReadings - 100);
    }
    return sum;
  };
  EXPECT_LT(lateness(0), -0.25) << "33 steps late, at 1.1 % a step";
  EXPECT_NEAR(lateness(1), 0, 0.15);
}

TEST(AdaptiveCubatureFilter, TheReportedCovarianceIsThatOfItsErrors) {
  for (const double outliers : {0.0, 0.1}) {
    auto options = huber();
    options.adaptive = options.calibrate = true;
    const Filter filter(options);
    std::vector<double> nees;
    Random random = testing::announced(8);
    for (int run = 0; run < 300; ++run) {
      Belief belief(kPrior);
      belief.state.mean = kTruth + 2 * testing::randomMatrix<kN>(random);
      for (int k = 0; k < 1000; ++k) {
        const Vector<kM> z = reading(random, random.bernoulli(outliers) ? 100 : 1);
        belief = filter.update(belief, z, kVariance, kPresent, rangeAndBearing, PlainDifference()).belief;
      }
      const Vector<kN> error = belief.state.mean - kTruth;
      nees.push_back(error.dot(belief.state.covariance.llt().solve(error)) / kN);
    }
    EXPECT_NEAR(mean(nees), 1, 0.15) << outliers;
  }
}

TEST(AdaptiveCubatureFilter, ABadCovarianceIsReportedAndTheBeliefKept) {
  Belief broken(kPrior);
  broken.own(0, 0) = -1;
  Random random(9);
  const auto result = updated(huber(), broken, reading(random));
  EXPECT_EQ(result.verdict, Verdict::Invalid);
  EXPECT_EQ(result.belief.state.mean, kPrior.mean);
}

}  // namespace
}  // namespace sas_motion
