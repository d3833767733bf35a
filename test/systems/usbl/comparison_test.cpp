// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/comparison.hpp"

#include <gtest/gtest.h>

#include "sas_motion/systems/usbl/simulator.hpp"

namespace sas_motion::usbl {
namespace {

std::vector<Ping> pingsOf(Scenario scenario, double duration = 400) {
  scenario.duration = duration;
  std::vector<Ping> pings;
  for (const auto& labelled : simulatePings(scenario, 3)) pings.push_back(labelled.ping);
  return pings;
}

TEST(Comparison, EveryEstimatorIsWithinFourSigmaAndTheAnswerIsTrusted) {
  const Scenario scenario;
  auto names = filterNames();
  names.emplace_back("batch");
  const Comparison comparison = compare(pingsOf(scenario), {}, names);
  EXPECT_TRUE(comparison.trusted()) << comparison.observability.verdict;
  EXPECT_EQ(comparison.best().name, "hvbckf");
  ASSERT_EQ(comparison.estimates.size(), names.size());
  for (const auto& estimated : comparison.estimates)
    for (int i = 0; i < kStates; ++i)
      EXPECT_LT(std::abs(estimated.x(i) - scenario.truth(i)), 4 * estimated.sigma()(i)) << estimated.name << " " << i;
}

TEST(Comparison, BatchAnswersWhereFurtherUnknownsAreEstimated) {
  Scenario scenario;
  scenario.truth(kTransponderX) = 0.15;
  Config config;
  for (const auto i : {kTransponderX, kTransponderY, kTransponderZ}) config.prior.estimated[i] = true;
  const Comparison comparison = compare(pingsOf(scenario), config, {"hvbckf"});
  EXPECT_EQ(comparison.best().name, "batch");
  EXPECT_NEAR(comparison.best().x(kTransponderX), 0.15, 4 * comparison.best().sigma()(kTransponderX));
}

TEST(Comparison, AFilterThatDoesNotStartLeavesTheAnswerToBatch) {
  const Comparison comparison = compare(pingsOf(Scenario(), 40), {}, {"hvbckf"});
  EXPECT_NE(comparison.estimates[0].failure.find("60 s"), std::string::npos);
  EXPECT_EQ(comparison.best().name, "batch");
}

TEST(Comparison, RangesAloneAreNotTrusted) {
  auto pings = pingsOf(Scenario());
  for (auto& ping : pings) ping.reading.variance.tail<2>().setConstant(-1);
  const Comparison comparison = compare(pings, {}, {"hvbckf"});
  EXPECT_FALSE(comparison.trusted());
  EXPECT_NE(comparison.observability.verdict.find("mounting angle"), std::string::npos);
}

TEST(Comparison, AnswersThatContradictEachOtherAreNotTrusted) {
  const FitterFactory biased = [](const std::string& name) -> Fitter {
    if (name != "batch") return {};
    return [](const Problem& problem, const FitOptions& options) {
      Fit result = fit(problem, options);
      result.x(kLeverX) += 10 * std::sqrt(result.covariance(kLeverX, kLeverX));
      return result;
    };
  };
  const Comparison comparison = compare(pingsOf(Scenario()), {}, {"hvbckf"}, biased);
  EXPECT_FALSE(comparison.agrees);
  EXPECT_FALSE(comparison.trusted());
}

TEST(Comparison, SwappedAxesAreNotTrustedEvenByBatchAlone) {
  auto pings = pingsOf(Scenario());
  for (auto& ping : pings) std::swap(ping.reading.value(1), ping.reading.value(2));
  const Comparison comparison = compare(pings, {}, {"batch", "batch"});
  EXPECT_EQ(comparison.estimates.size(), 1u);
  EXPECT_NE(comparison.implausible.find("check axes, units and clocks"), std::string::npos);
  EXPECT_FALSE(comparison.trusted());
}

TEST(Comparison, WarnsOfAnArrayThatIsMountedOtherwiseThanExpected) {
  Scenario scenario;
  scenario.truth(kMountingZ) = 0.6;
  const Comparison comparison = compare(pingsOf(scenario), {}, {"hvbckf"});
  ASSERT_FALSE(comparison.warnings.empty());
  EXPECT_NE(comparison.warnings[0].find("mounting_z"), std::string::npos);
}

}  // namespace
}  // namespace sas_motion::usbl
