// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum_filter.hpp"

#include <cmath>

#include "filters/eight_laws.hpp"
#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
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
    Transition<6> step{Vector<6>::Zero(), Matrix<6>::Identity() + 0.1 * testing::randomMatrix<6, 6>(random),
                       0.01 * testing::randomCovariance<6>(random)};
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
    ASSERT_EQ(b.blocks.front().hypotheses.size(), 1u);
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
  EXPECT_EQ(found.blocks.front().hypotheses.size(), 4u);
  EXPECT_LT(relativeDifference(gaussian(found).mean, expected.mean), 1e-12);
  EXPECT_LT(relativeDifference(gaussian(found).covariance, expected.covariance), 1e-11);
}

TEST(GaussianSumFilter, MergingKeepsMeanAndCovariance) {
  Random random = announced(73);
  GaussianSum<6> sum;
  sum.blocks.emplace_back();
  auto& block = sum.blocks.front();
  for (int i = 0; i < 30; ++i)
    block.hypotheses.push_back(
        {testing::randomMatrix<6>(random), testing::randomCovariance<6>(random), random.gaussian(), 0, 0});
  sum.summarize();
  const auto before = sum.summary;
  block.reduce(30, 4);
  EXPECT_LT(block.hypotheses.size(), 20u);
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
    EXPECT_EQ(belief.blocks.front().hypotheses.size(), expected[i]) << i;
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

TEST(GaussianSumFilter,
     WhatNothingCouplesIsFollowedApart) {  // with what is merged and left out, so that it is not the exact posterior
  GaussianSumOptions options;
  options.measurement = studentTerms(3);
  const GaussianSumFilter<6> all(options);
  const GaussianSumFilter<2> one(options);
  GaussianSum<6> belief{Gaussian<6>{}};
  GaussianSum<2> north{Gaussian<2>{}}, down = north;
  Random random = announced(75);
  for (const auto& sample : testing::cvRun(testing::kEightLaws[4], random, 60)) {
    belief = all.predict(belief, testing::kCv.transition(belief.summary.mean));
    belief = all.update(belief, testing::kCv.measurement(sample.z, belief.summary.mean, 0)).belief;
    for (const auto& [axis, sum] : {std::pair{1, &north}, {2, &down}}) {
      *sum = one.predict(*sum, testing::cvAxis(sum->summary.mean));
      *sum = one.update(*sum, LinearMeasurement<2, 1>{Vector<1>(sample.z(axis) - sum->summary.mean(0)),
                                                      Matrix<1, 2>(1, 0), Matrix<1>(1.0)})
                 .belief;
      ASSERT_NEAR(belief.summary.mean(axis), sum->summary.mean(0), 1e-9);
      ASSERT_NEAR(belief.summary.mean(axis + 3), sum->summary.mean(1), 1e-9);
      ASSERT_NEAR(belief.summary.covariance(axis, axis + 3), sum->summary.covariance(0, 1), 1e-9);
    }
  }
  EXPECT_EQ(belief.blocks.size(), 3u);
}

TEST(GaussianSumFilter, WhatStartMotionRowOrACommonCauseCouplesIsOneBlock) {
  const auto step = testing::kCv.transition(Vector<6>::Zero());
  const auto z = testing::kCv.measurement(Vector<4>::Zero(), Vector<6>::Zero(), 1);
  const auto blocks = [&](const GaussianSumOptions& options, const Matrix<6>& P,
                          const LinearMeasurement<6, 4>& measurement) {
    const GaussianSumFilter<6> filter(options);
    return filter.update(filter.predict(GaussianSum<6>{Gaussian<6>{Vector<6>::Zero(), P}}, step), measurement)
        .belief.blocks.size();
  };
  const Matrix<6> apart = Matrix<6>::Identity();
  EXPECT_EQ(blocks({}, apart, z), 3u);
  Matrix<6> together = apart;
  together(0, 4) = together(4, 0) = 0.1;
  EXPECT_EQ(blocks({}, together, z), 2u);
  auto sum = z;
  sum.H(1, 2) = -1;
  EXPECT_EQ(blocks({}, apart, sum), 2u);
  GaussianSumOptions scale;
  scale.process = {{1, 0.9}, {100, 0.1}};
  EXPECT_EQ(blocks(scale, apart, z), 1u);
  GaussianSumOptions mode;
  mode.mode.rate = 0.01;
  mode.mode.rows = 0b0110;
  EXPECT_EQ(blocks(mode, apart, z), 3u);
  mode.mode.common = true;
  EXPECT_EQ(blocks(mode, apart, z), 2u);
}

TEST(GaussianSumFilter, JoiningBlocksKeepsMeanAndCovariance) {
  Random random = announced(76);
  GaussianSum<6> sum;
  for (const auto& states : {Vector<6>{1, 0, 1, 0, 0, 0}, Vector<6>{0, 1, 0, 1, 1, 1}}) {
    sum.blocks.push_back({states});
    for (int i = 0; i < 5; ++i)
      sum.blocks.back().hypotheses.push_back({states.cwiseProduct(testing::randomMatrix<6, 1>(random)),
                                              sum.blocks.back().own(testing::randomCovariance<6>(random)),
                                              random.gaussian()});
  }
  sum.summarize();
  const auto before = sum.summary;
  sum.couple(Matrix<6>::Ones(), 25, 0);
  ASSERT_EQ(sum.blocks.size(), 1u);
  EXPECT_EQ(sum.blocks.front().hypotheses.size(), 25u);
  sum.summarize();
  EXPECT_LT(relativeDifference(sum.summary.mean, before.mean), 1e-12);
  EXPECT_LT(relativeDifference(sum.summary.covariance, before.covariance), 1e-12);
}

TEST(GaussianSumFilter, ABurstFromTheFirstReadingIsNotTakenForTheTruth) {
  GaussianSumOptions options;
  options.mode.rate = 0.02;
  options.mode.length = 5;
  const GaussianSumFilter<2> filter(options);
  GaussianSum<2> belief{Gaussian<2>{Vector<2>::Zero(), Vector<2>(1, 0.01).asDiagonal()}};  // too slow to get there
  for (int i = 0; i < 40; ++i) {
    belief = filter.predict(belief, testing::cvAxis(belief.summary.mean));
    LinearMeasurement<2, 1> z{Vector<1>((i < 10 ? 20 : 0) - belief.summary.mean(0)), Matrix<1, 2>(1, 0),
                              Matrix<1>(1.0)};
    z.time = 0.5 * i;  // from 0: a stamp like any other
    const auto update = filter.update(belief, z);
    belief = update.belief;
    ASSERT_LT(std::abs(belief.summary.mean(0)), 1) << i;
    if (i > 12) {
      ASSERT_GT(update.weights(0), 0.9) << i;
    }
  }
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
