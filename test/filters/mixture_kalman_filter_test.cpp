// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/mixture_kalman_filter.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

using Options2 = MixtureKalmanFilter<2>::Options;

/// The exact posterior of one scalar row: a Kalman update for each scale, weighed by its likelihood, moments taken at
/// the end.
Gaussian<2> gaussianSum(const Gaussian<2>& prior, const LinearMeasurement<2, 1>& z, const Options2& options) {
  std::array<Gaussian<2>, 4> posteriors;
  std::array<double, 4> likelihoods{};
  double total = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    auto scaled = z;
    scaled.R *= options.scales[j];
    const auto update = KalmanFilter<2>().update(prior, scaled);
    posteriors[j] = update.belief;
    likelihoods[j] = options.probabilities[j] * std::exp(-0.5 * update.nis) / std::sqrt(update.S(0, 0));
    total += likelihoods[j];
  }
  Gaussian<2> sum{Vector<2>::Zero(), Matrix<2>::Zero()};
  for (std::size_t j = 0; j < 4; ++j) sum.mean += likelihoods[j] / total * posteriors[j].mean;
  for (std::size_t j = 0; j < 4; ++j) {
    const Vector<2> off = posteriors[j].mean - sum.mean;
    sum.covariance += likelihoods[j] / total * (posteriors[j].covariance + off * off.transpose());
  }
  return sum;
}

TEST(MixtureKalmanFilter, HasTheMomentsOfTheExactGaussianSum) {
  Random random = announced(51);
  const Options2 options;
  for (const double size : {0.1, 1.0, 3.0, 6.0, 20.0}) {
    for (int i = 0; i < 10; ++i) {
      const auto prior = testing::randomBelief<2>(random);
      auto z = testing::randomMeasurement<2, 1>(random);
      z.innovation(0) *= size;
      const auto update = MixtureKalmanFilter<2>(options).update(prior, z).belief;
      const auto expected = gaussianSum(prior, z, options);
      EXPECT_LT(relativeDifference(update.mean, expected.mean), 1e-9) << size;
      EXPECT_LT(relativeDifference(update.covariance, expected.covariance), 1e-9) << size;
    }
  }
}

TEST(MixtureKalmanFilter, HasTheMomentsOfTheIntegratedDensity) {
  const Options2 options;
  const Gaussian<2> prior{{0, 0}, Vector<2>(4, 1).asDiagonal()};
  for (const double z_value : {0.5, 2.0, 5.0, 12.0}) {
    LinearMeasurement<2, 1> z;
    z.innovation(0) = z_value;
    z.H << 1, 0;
    z.R(0, 0) = 0.25;
    double mass = 0, first = 0, second = 0;
    for (double x = -20; x <= 20; x += 1e-3) {
      double noise = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        const double variance = options.scales[j] * z.R(0, 0);
        noise +=
            options.probabilities[j] * std::exp(-0.5 * (z_value - x) * (z_value - x) / variance) / std::sqrt(variance);
      }
      const double density = std::exp(-0.5 * x * x / 4) * noise;
      mass += density;
      first += x * density;
      second += x * x * density;
    }
    const auto belief = MixtureKalmanFilter<2>(options).update(prior, z).belief;
    EXPECT_NEAR(belief.mean(0), first / mass, 1e-6) << z_value;
    EXPECT_NEAR(belief.covariance(0, 0), second / mass - std::pow(first / mass, 2), 1e-6) << z_value;
    EXPECT_NEAR(belief.covariance(1, 1), 1, 1e-12) << "a state that is not measured";
  }
}

TEST(MixtureKalmanFilter, WithOneScaleIsTheKalmanFilter) {
  Random random = announced(52);
  MixtureKalmanFilter<6>::Options options;
  options.probabilities = {0, 0, 1, 0};
  options.scales = {1, 9, 1, 2500};
  const MixtureKalmanFilter<6> filter(options);
  for (int i = 0; i < 20; ++i) {
    const auto prior = testing::randomBelief<6>(random);
    const auto z = testing::randomMeasurement<6, 4>(random);
    const auto kalman = KalmanFilter<6>().update(prior, z), mixture = filter.update(prior, z);
    EXPECT_LT(relativeDifference(mixture.belief.mean, kalman.belief.mean), 1e-10);
    EXPECT_LT(relativeDifference(mixture.belief.covariance, kalman.belief.covariance), 1e-10);
    EXPECT_EQ(mixture.weights, Vector<4>(Vector<4>::Ones()));
  }
}

TEST(MixtureKalmanFilter, DoubtAboutAReadingStaysInTheCovariance) {
  const Gaussian<2> prior;
  LinearMeasurement<2, 1> z;
  z.H << 1, 0;
  z.R(0, 0) = 0.01;
  double widest = 0;
  for (double d = 0; d < 40; d += 0.5) {
    z.innovation(0) = d;
    widest = std::max(widest, MixtureKalmanFilter<2>({}).update(prior, z).belief.covariance(0, 0));
  }
  z.innovation(0) = 0;
  EXPECT_LT(MixtureKalmanFilter<2>({}).update(prior, z).belief.covariance(0, 0), 0.05);
  EXPECT_GT(widest, 0.5);  // between clean and outlier it cannot tell
}

TEST(MixtureKalmanFilter, RefusesBadOptions) {
  MixtureKalmanFilter<6>::Options options;
  options.scales[2] = 0;
  EXPECT_THROW(MixtureKalmanFilter<6>{options}, std::invalid_argument);
  options = {};
  options.probabilities[1] = -0.1;
  EXPECT_THROW(MixtureKalmanFilter<6>{options}, std::invalid_argument);
  options.probabilities = {0, 0, 0, 0};
  EXPECT_THROW(MixtureKalmanFilter<6>{options}, std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion
