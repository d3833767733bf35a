// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gated_kalman_filter.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

/// A reading of state 0 that is `sigmas` standard deviations of its innovation off.
LinearMeasurement<6, 1> reading(const Gaussian<6>& prior, double sigmas) {
  LinearMeasurement<6, 1> z;
  z.H.setZero();
  z.H(0, 0) = 1;
  z.R(0, 0) = 1;
  z.innovation(0) = sigmas * std::sqrt(prior.covariance(0, 0) + 1);
  return z;
}

TEST(GatedKalmanFilter, IsTheKalmanFilterInsideTheGate) {
  Random random = testing::announced(61);
  const auto prior = testing::randomBelief<6>(random);
  const auto z = reading(prior, 2.5);
  const auto gated = GatedKalmanFilter<6>({}).update(prior, z);
  EXPECT_EQ(gated.belief.mean, KalmanFilter<6>().update(prior, z).belief.mean);
  EXPECT_EQ(gated.verdict, Verdict::Accepted);
}

TEST(GatedKalmanFilter, RejectsATenSigmaReading) {
  Random random = testing::announced(62);
  const auto prior = testing::randomBelief<6>(random);
  const auto update = GatedKalmanFilter<6>({}).update(prior, reading(prior, 10));
  EXPECT_EQ(update.verdict, Verdict::Rejected);
  EXPECT_EQ(update.belief.mean, prior.mean);
  EXPECT_EQ(update.belief.covariance, prior.covariance);
  EXPECT_EQ(update.weights(0), 0);
  EXPECT_NEAR(update.nis, 100, 1e-9);
}

TEST(GatedKalmanFilter, TheGateLetsThroughItsShareOfGoodReadings) {
  Random random = testing::announced(63);
  for (const double probability : {0.9, 0.99}) {
    GatedKalmanFilter<6>::Options options;
    options.probability = probability;
    const GatedKalmanFilter<6> filter(options);
    const int draws = 20000;
    int rejected = 0;
    for (int i = 0; i < draws; ++i)
      rejected += filter.update(Gaussian<6>(), reading(Gaussian<6>(), random.gaussian())).verdict == Verdict::Rejected;
    const double sigma = std::sqrt(draws * probability * (1 - probability));
    EXPECT_NEAR(rejected, draws * (1 - probability), 4 * sigma);
  }
}

TEST(GatedKalmanFilter, RefusesAProbabilityOutsideZeroToOne) {
  for (const double bad : {0.0, 1.0, -0.5, std::nan("")})
    EXPECT_THROW(GatedKalmanFilter<6>({bad}), std::invalid_argument) << bad;
}

}  // namespace
}  // namespace sas_motion
