// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What arrives broken is counted and does no harm.
#include <cmath>
#include <limits>

#include "sas_motion/systems/towfish/session.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

using testing::feed;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

/// Every way to break a measurement, one each.
std::vector<Measurement> broken(const Measurement& good) {
  std::vector<Measurement> all;
  const auto add = [&](auto&& damage) {
    Measurement z = good;
    z.stamp += 1;  // no duplicate
    damage(z);
    all.push_back(z);
  };
  for (const double bad : {kNan, kInf, -kInf}) {
    add([&](auto& z) { z.value(0) = bad; });
    add([&](auto& z) { z.value(1) = bad; });
    add([&](auto& z) { z.lever_arm_body(0) = bad; });
  }
  for (const double bad : {kNan, 0.0, -1.0, kInf, 1e-310})
    for (int row = 0; row < rowsOf(good.sensor); ++row) add([&](auto& z) { z.variance(row) = bad; });
  for (const Stamp bad : {Stamp{0}, Stamp{-5}}) add([&](auto& z) { z.stamp = bad; });
  add([&](auto& z) { z.value.setConstant(1e9); });
  if (good.sensor == Sensor::Heading) all.pop_back();  // any finite angle is one
  return all;
}

class Faults : public ::testing::TestWithParam<std::string> {};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(EveryFilter, Faults, ::testing::ValuesIn(testing::filterNames()), nameOf);

TEST_P(Faults, BrokenMeasurementsAreCountedAndChangeNothing) {
  const auto scenario = testing::survey(30);
  const Config config = testing::configFor(scenario);
  const auto good = testing::simulate(scenario, 1).measurements;
  std::vector<Measurement> mixed;
  std::size_t bad = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    mixed.push_back(good[i]);
    if (i % 20 != 7) continue;
    for (const auto& z : broken(good[i])) mixed.push_back(z);
    bad += broken(good[i]).size();
  }
  ASSERT_GT(bad, 300u);
  const auto output = feed(GetParam(), config, mixed);
  EXPECT_EQ(testing::count(output, Verdict::Invalid), bad);
  testing::expectSameEstimates(feed(GetParam(), config, good), output, "without the broken ones");
}

TEST_P(Faults, OutrageousCovariancesAndGapsDoNotBreakIt) {
  const auto scenario = testing::survey(60);
  auto measurements = testing::simulate(scenario, 2).measurements;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    if (i % 50 == 10) measurements[i].variance.setConstant(1e-12);
    if (i % 50 == 20) measurements[i].variance.setConstant(9e11);
    if (i > measurements.size() / 2) measurements[i].stamp += 86'400 * kNanosecondsPerSecond;  // a day without data
  }
  const auto output = feed(GetParam(), testing::configFor(scenario), measurements);
  ASSERT_GT(output.solutions.size(), 500u);
  for (const auto& estimate : output.solutions) {
    ASSERT_TRUE(estimate.belief.mean.allFinite());
    ASSERT_TRUE(estimate.belief.covariance.allFinite());
    ASSERT_GE(estimate.belief.covariance.diagonal().minCoeff(), 0);
  }
}

TEST_P(Faults, WhenTheClockIsSetBackItStartsAgain) {
  auto scenario = testing::survey(60);
  const auto run = testing::simulate(scenario, 3);
  const auto estimator = testing::timelineOf(GetParam(), testing::configFor(scenario));
  feed(*estimator, run.measurements);
  auto again = run.measurements;
  const Stamp back = 3600 * kNanosecondsPerSecond;
  for (auto& z : again) z.stamp -= back;
  const auto output = feed(*estimator, again);
  EXPECT_EQ(testing::count(output, Verdict::Stale), 0u);
  ASSERT_GT(output.solutions.size(), 1000u);
  auto last = output.solutions.back();
  EXPECT_EQ(last.stamp, again.back().stamp);
  last.stamp += back;
  EXPECT_LT(testing::positionError(last, run), 3);
}

TEST_P(Faults, OneStampFarInTheFutureDoesNotStopIt) {
  const auto scenario = testing::survey(60);
  const auto run = testing::simulate(scenario, 4);
  auto measurements = run.measurements;
  measurements[measurements.size() / 2].stamp += 1'000'000 * kNanosecondsPerSecond;
  const auto output = feed(GetParam(), testing::configFor(scenario), measurements);
  std::size_t after = 0;
  for (const auto& estimate : output.solutions) {
    if (estimate.stamp > run.truth.back().stamp) continue;  // the one at the wrong stamp
    after += secondsBetween(Simulator::kStart, estimate.stamp) > 35;
    ASSERT_LT(testing::positionError(estimate, run), 5) << secondsBetween(Simulator::kStart, estimate.stamp);
  }
  EXPECT_GT(after, 500u);
}

TEST(Faults, ResetForgetsEverything) {
  const auto scenario = testing::survey(30);
  const OutputFrame frame{LocalFrame(Geodetic{10, 20, 0}), {}};
  const auto solutions = [&](TowfishSession& session, std::uint64_t seed) {
    for (const auto& z : testing::simulate(scenario, seed).measurements) session.process(z);
    session.finish();
    sas_motion::Output output;
    session.takeSettled(0, frame, output);
    return output.solutions;
  };
  TowfishSession session(testing::configFor(scenario), {"mixture_kf"}, makeEstimator),
      fresh(testing::configFor(scenario), {"mixture_kf"}, makeEstimator);
  solutions(session, 6);
  ASSERT_TRUE(session.current(0, frame));
  session.reset();
  EXPECT_FALSE(session.current(0, frame));
  const auto expected = solutions(fresh, 5), again = solutions(session, 5);
  ASSERT_EQ(expected.size(), again.size());
  for (std::size_t i = 0; i < again.size(); ++i) ASSERT_EQ(expected[i].position_map, again[i].position_map) << i;
}

TEST(Faults, WithoutAPositionOrAHeadingItStaysSilentAndSaysWhy) {
  for (const Sensor missing : {Sensor::Position, Sensor::Heading}) {
    auto scenario = testing::survey(30);
    scenario.sensor(missing).rate = 0;
    const auto measurements = testing::simulate(scenario, 7).measurements;
    const auto output = feed("kf", testing::configFor(scenario), measurements);
    EXPECT_TRUE(output.solutions.empty());
    EXPECT_EQ(testing::count(output, Verdict::Stale), measurements.size());
    EXPECT_EQ(output.audits.front().reason, "before the first position and heading");
  }
}

}  // namespace
}  // namespace sas_motion::towfish
