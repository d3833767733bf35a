// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum_filter.hpp"

#include <cmath>

#include "filters/eight_laws.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/evaluation/law_aware.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

TEST(GaussianSumFilter, WithOneTermEachIsTheKalmanFilter) {
  Random random = announced(71);
  const KalmanFilter<6> kalman;
  const GaussianSumFilter<6> sum({});
  Gaussian<6> a = testing::randomBelief<6>(random);
  GaussianSum<6> b{a};
  for (int i = 0; i < 200; ++i) {
    Transition<6> step{Vector<6>::Zero(), Matrix<6>::Identity() + 0.1 * testing::randomMatrix<6, 6>(random), 0.01 * testing::randomCovariance<6>(random)};
    step.mean = step.F * a.mean;
    a = kalman.predict(a, step);
    b = sum.predict(b, step);
    const auto z = testing::randomMeasurement<6, 4>(random);
    const auto expected = kalman.update(a, z);
    const auto found = sum.update(b, z);
    a = expected.belief;
    b = found.belief;
    ASSERT_LT(relativeDifference(gaussian(b).mean, a.mean), 1e-12) << i;
    ASSERT_LT(relativeDifference(gaussian(b).covariance, a.covariance), 1e-12) << i;
    ASSERT_NEAR(found.nis, expected.nis, 1e-9 * expected.nis);
    ASSERT_EQ(found.verdict, Verdict::Accepted);
    ASSERT_EQ(b.hypotheses.size(), 1u);
  }
}

TEST(GaussianSumFilter, WithoutMergingHasTheExactPosteriorOfAllBranches) {
  Random random = announced(72);
  GaussianSumOptions options;
  options.measurement = {{1, 0.9, 0}, {100, 0.1, 0.5}};
  options.process = {{1, 0.95}, {100, 0.05}};
  options.merge = 0;
  options.hypotheses = options.branches = 64;
  const GaussianSumFilter<2> filter(options);
  const Gaussian<2> start = testing::randomBelief<2>(random);
  const auto step = testing::cvAxis(start.mean);
  auto z = testing::randomMeasurement<2, 1>(random);
  z.innovation(0) = 4;
  const auto found = filter.update(filter.predict(GaussianSum<2>{start}, step), z).belief;

  Gaussian<2> expected{Vector<2>::Zero(), Matrix<2>::Zero()};
  Matrix<2> second = Matrix<2>::Zero();
  double total = 0;
  for (const auto& p : options.process)
    for (const auto& m : options.measurement) {
      auto large = step;
      large.Q *= p.variance;
      auto wide = z;
      wide.R *= m.variance;
      wide.innovation(0) -= m.mean * std::sqrt(z.R(0, 0));
      const auto update = KalmanFilter<2>().update(predictGaussian(start, large), wide);
      const double weight = p.probability * m.probability * std::exp(-0.5 * update.nis) / std::sqrt(update.S(0, 0));
      total += weight;
      expected.mean += weight * update.belief.mean;
      second += weight * (update.belief.covariance + update.belief.mean * update.belief.mean.transpose());
    }
  expected.mean /= total;
  expected.covariance = second / total - expected.mean * expected.mean.transpose();
  EXPECT_EQ(found.hypotheses.size(), 4u);
  EXPECT_LT(relativeDifference(gaussian(found).mean, expected.mean), 1e-12);
  EXPECT_LT(relativeDifference(gaussian(found).covariance, expected.covariance), 1e-11);
}

TEST(GaussianSumFilter, MergingKeepsMeanAndCovariance) {
  Random random = announced(73);
  GaussianSum<6> sum;
  for (int i = 0; i < 30; ++i) sum.hypotheses.push_back({testing::randomMatrix<6>(random), testing::randomCovariance<6>(random), random.gaussian(), 0, 0});
  sum.summarize();
  const auto before = sum.summary;
  sum.reduce(30, 20);
  EXPECT_LT(sum.hypotheses.size(), 20u);
  sum.summarize();
  EXPECT_LT(relativeDifference(sum.summary.mean, before.mean), 1e-12);
  EXPECT_LT(relativeDifference(sum.summary.covariance, before.covariance), 1e-12);
}

TEST(GaussianSumFilter, AnEpochKeepsItsScaleUntilTheFirstUpdateAfterItsEnd) {
  GaussianSumOptions options;
  options.process = {{1, 0.5}, {100, 0.5}};
  options.epoch = 1;
  options.merge = 0;
  const GaussianSumFilter<2> filter(options);
  LinearMeasurement<2, 1> z{Vector<1>(0.3), Matrix<1, 2>(1, 0), Matrix<1>(1.0)};
  GaussianSum<2> belief{Gaussian<2>{}};
  const std::array<std::size_t, 6> expected{2, 2, 2, 2, 4, 4};  // at 0.25, 0.5, 0.75, 1, 1.25, 1.5 s
  for (std::size_t i = 0; i < expected.size(); ++i) {
    z.time = 0.25 * static_cast<double>(i + 1) + 1.6e9;
    belief = filter.predict(belief, testing::cvAxis(belief.summary.mean));
    if (i == 0) belief.epoch_end = 1.6e9 + 1;
    belief = filter.update(belief, z).belief;
    EXPECT_EQ(belief.hypotheses.size(), expected[i]) << i;
  }
}

TEST(GaussianSumFilter, OnlyTheBiasedRowIsNotBelieved) {
  GaussianSumOptions options;
  options.mode.rate = 0.01;
  options.mode.length = 10;
  const GaussianSumFilter<6> filter(options);
  GaussianSum<6> belief{Gaussian<6>{}};
  Vector<2> weights = Vector<2>::Zero();
  for (int i = 1; i <= 20; ++i) {
    LinearMeasurement<6, 2> z;
    z.H.setZero();
    z.H(0, 0) = z.H(1, 1) = 1;
    z.R.setIdentity();
    z.innovation = Vector<2>(i > 10 ? 20 : 0, 0) - z.H * belief.summary.mean;
    z.time = i;
    const auto update = filter.update(belief, z);
    belief = update.belief;
    weights = update.weights;
  }
  EXPECT_LT(weights(0), 0.01);
  EXPECT_GT(weights(1), 0.9);
  EXPECT_LT(std::abs(belief.summary.mean(0)), 0.1);
}

TEST(GaussianSumFilter, SouthIsNoWorseThanNorth) {  // where headings wrap
  NoiseLaw process = testing::contaminated(0.05, 10);
  process.epoch = 0.5;
  const GaussianSumFilter<6> filter(lawAware(testing::contaminated(0.1, 10), process, 0.1));
  const towfish::Model model({});
  const auto errors = [&](double heading) {
    Random random(74);
    std::vector<double> result;
    GaussianSum<6> belief{Gaussian<6>{Vector<6>::Unit(towfish::kHeading) * heading, 0.01 * Matrix<6>::Identity()}};
    for (int i = 1; i <= 200; ++i) {
      belief = filter.predict(belief, model.transition(belief.summary.mean, {}, 0.1));
      towfish::Measurement z;
      z.sensor = towfish::Sensor::Heading;
      z.stamp = stampFromSeconds(0.1 * i);
      z.variance.setConstant(1e-4);
      z.value(0) = wrapAngle(heading + 0.01 * random.gaussian() * (random.bernoulli(0.1) ? 10 : 1));
      belief = filter.update(belief, model.heading(z, belief.summary.mean)).belief;
      result.push_back(wrapAngle(belief.summary.mean(towfish::kHeading) - heading));
    }
    return result;
  };
  std::cout << "seed 74\n";
  const auto north = errors(0), south = errors(kPi);
  for (std::size_t i = 0; i < north.size(); ++i) ASSERT_NEAR(south[i], north[i], 1e-9) << i;
}

TEST(GaussianSumFilter, RefusesOptionsOutOfRange) {
  const auto make = [](auto&& change) {
    GaussianSumOptions options;
    change(options);
    GaussianSumFilter<2> filter(options);
  };
  EXPECT_THROW(make([](auto& o) { o.measurement.clear(); }), std::invalid_argument);
  EXPECT_THROW(make([](auto& o) { o.process[0].variance = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& o) { o.measurement[0].probability = -1; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& o) { o.persistence = 1; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& o) { o.mode.length = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& o) { o.branches = 3; }), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion
