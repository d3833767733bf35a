// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/problem.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "support.hpp"

namespace sas_motion::usbl {
namespace {

Scenario scenario(double outliers = 0.1) {
  Scenario result;
  result.track.centre = result.transponder_map.head<2>();
  NoiseLaw law;
  law.kind = NoiseLaw::Kind::Contaminated;
  law.epsilon = outliers;
  law.K = 10;
  result.noise.fill(law);
  return result;
}

Problem problemOf(const Scenario& scenario, std::uint64_t seed) {
  Problem problem;
  for (const auto& labelled : simulatePings(scenario, seed)) problem.pings.push_back(labelled.ping);
  return problem;
}

double distance(const Fit& fit, const Unknowns& truth) {
  const State error = (fit.x - truth).head<kStates>();
  return error.dot(Matrix<kStates>(fit.covariance.topLeftCorner<kStates, kStates>()).llt().solve(error)) / kStates;
}

TEST(RobustFit, FindsTheTruthAndSaysHowWell) {
  double sum = 0;
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto found = fit(problemOf(scenario(), seed), {});
    EXPECT_EQ(found.failure, "");
    sum += distance(found, scenario().truth) / kSeeds;
  }
  EXPECT_NEAR(sum, 1, 0.3) << "seeds 1 to " << kSeeds << ", NEES over six unknowns";  // standard error 0.1
}

TEST(RobustFit, IsAtAMinimumOfItsCost) {
  Problem problem = problemOf(scenario(), 3);
  const auto found = fit(problem, {});
  problem.scale = found.scale;
  EXPECT_NEAR(found.cost, cost(problem, Loss(LossKind::Huber), found.x), 1e-9 * found.cost);
  for (int i = 0; i < kStates; ++i)
    for (const double sign : {-1.0, 1.0}) {
      const Unknowns aside = found.x + sign * 0.1 * std::sqrt(found.covariance(i, i)) * Unknowns::Unit(i);
      EXPECT_GT(cost(problem, Loss(LossKind::Huber), aside), found.cost) << unknownNames()[static_cast<std::size_t>(i)];
    }
}

TEST(RobustFit, DoesNotMindHowWrongTheStatedNoiseIs) {
  Scenario wrong = scenario();
  wrong.stated_factor = 25;
  const auto right = fit(problemOf(scenario(), 4), {}), found = fit(problemOf(wrong, 4), {});
  for (int i = 0; i < kStates; ++i) EXPECT_NEAR(found.x(i), right.x(i), 0.02 * std::sqrt(right.covariance(i, i)));
  EXPECT_LT((found.scale * 5 - right.scale).norm(), 1e-3);
}

TEST(RobustFit, WeighsOutliersDown) {
  const Scenario sea = scenario();
  const auto labelled = simulatePings(sea, 5);
  const auto found = fit(problemOf(sea, 5), {});
  double good = 0, bad = 0, goods = 0, bads = 0;
  for (std::size_t i = 0; i < labelled.size(); ++i)
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const double weight = found.weights[i](static_cast<Eigen::Index>(channel));
      (labelled[i].outlier[channel] ? bad : good) += weight;
      (labelled[i].outlier[channel] ? bads : goods) += 1;
    }
  EXPECT_GT(good / goods, 0.9);
  EXPECT_LT(bad / bads, 0.4) << "0.33 is expected of ten times the noise";
}

TEST(RobustFit, FindsATransponderAndASoundSpeedThatAreOff) {
  Scenario sea = scenario(0);
  sea.truth.segment<3>(kTransponderX) << 0.1, -0.08, 0.06;
  sea.truth(kRangeScale) = 0.002;
  Problem problem = problemOf(sea, 6);
  const auto without = fit(problem, {});
  problem.prior.estimated.fill(true);
  const auto with = fit(problem, {});
  for (int i = kStates; i < kUnknowns; ++i)
    EXPECT_LT(std::abs(with.x(i) - sea.truth(i)), 4 * std::sqrt(with.covariance(i, i))) << i;
  EXPECT_GT(distance(without, sea.truth), 3 * distance(with, sea.truth));
  EXPECT_LT(std::sqrt(with.covariance(kRangeScale, kRangeScale)), 0.001);
}

TEST(RobustFit, WithoutPingsKeepsThePrior) {
  const auto found = fit(Problem(), {});
  EXPECT_EQ(found.failure, "");
  EXPECT_EQ(found.x, Unknowns::Zero());
  EXPECT_NEAR(std::sqrt(found.covariance(kLeverX, kLeverX)), 1, 1e-12);
}

TEST(Observability, ACentredCircleDoesNotTellHeadingFromTheForeAndAftArm) {
  Scenario sea = scenario();
  sea.track.kind = Track::Kind::Circle;
  sea.track.radius = 220;
  const Problem problem = problemOf(sea, 7);
  const auto report = observability(problem, sea.truth);
  EXPECT_FALSE(report.observable);
  EXPECT_NE(report.verdict.find("heading mounting angle"), std::string::npos) << report.verdict;
  EXPECT_NE(report.verdict.find("fore-and-aft lever arm"), std::string::npos) << report.verdict;
  EXPECT_GT(report.bound(kLeverY), 0.3);
  const auto found = fit(problem, {});
  for (int i = 0; i < kStates; ++i)
    EXPECT_LT(std::abs(found.x(i) - sea.truth(i)), 3 * std::sqrt(found.covariance(i, i)))
        << unknownNames()[static_cast<std::size_t>(i)];
}

TEST(Observability, AFigureEightShowsEveryUnknown) {
  const auto report = observability(problemOf(scenario(), 8), scenario().truth);
  EXPECT_TRUE(report.observable) << report.verdict;
  // a second derivation's figures: 0.0095, 0.0083, 0.0071 degrees; 0.010, 0.012, 0.010 m
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(report.bound(i) / kRadPerDeg, 0.009, 0.003);
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(report.bound(i), 0.0115, 0.0035);
}

TEST(Observability, OnePingShowsNothingAlone) {
  Problem problem = problemOf(scenario(), 9);
  problem.pings.resize(1);
  const auto report = observability(problem, scenario().truth);
  EXPECT_FALSE(report.observable);
  EXPECT_GT(report.weak_sigma, 1e3);
}

}  // namespace
}  // namespace sas_motion::usbl
