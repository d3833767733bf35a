// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A clock that is set, a single stamp that is wrong, a long gap.
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

using testing::feed;

constexpr double kRecovery = 5;  // of data [s]

double secondsIn(const Measurement& z) { return secondsBetween(Simulator::kStart, z.stamp); }

class Clock : public ::testing::TestWithParam<std::string> {};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(EveryFilter, Clock, ::testing::ValuesIn(testing::filterNames()), nameOf);

TEST_P(Clock, RecoversFromBeingSetWithinFiveSecondsOfData) {
  const auto scenario = testing::survey(60);
  const auto run = testing::simulate(scenario, 8);
  for (const double jump : {1.0, -1.0, 3600.0, -3600.0, 3.15e8, -3.15e8}) {
    for (const double when : {30.0, 30.05}) {  // just before a fix, and just after one
      const auto estimator = testing::timelineOf(GetParam(), testing::configFor(scenario));
      Output output;
      for (const auto& z : run.measurements) {
        Measurement moved = z;
        if (secondsIn(z) > when) moved.stamp += stampFromSeconds(jump);
        estimator->process(moved, output);
        if (secondsIn(z) < when + kRecovery) continue;
        auto now = estimator->current();
        ASSERT_TRUE(now) << jump << " s, at " << secondsIn(z);
        now->stamp -= stampFromSeconds(jump);
        ASSERT_EQ(now->stamp, z.stamp) << jump << " s, at " << secondsIn(z);
        ASSERT_LT(testing::positionError(*now, run), 4) << jump << " s, at " << secondsIn(z);
      }
    }
  }
}

TEST_P(Clock, OneWrongStampChangesNothingThatIsPublishedLive) {
  const auto scenario = testing::survey(40);
  const Config config = testing::configFor(scenario);
  const auto measurements = testing::simulate(scenario, 4).measurements;
  for (const double wrong : {-3.15e8, -3600.0, -20.0, 20.0, 3600.0, 3.15e8}) {
    const auto straight = testing::timelineOf(GetParam(), config), estimator = testing::timelineOf(GetParam(), config);
    Output expected, output;
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      if (i % 97 == 50) {
        Measurement bad = measurements[i];
        bad.stamp += stampFromSeconds(wrong);
        estimator->process(bad, output);
      }
      estimator->process(measurements[i], output);
      straight->process(measurements[i], expected);
      const auto now = estimator->current(), should = straight->current();
      ASSERT_EQ(now.has_value(), should.has_value()) << wrong << " s, at " << secondsIn(measurements[i]);
      if (!now) continue;
      ASSERT_EQ(now->belief.mean, should->belief.mean) << wrong << " s, at " << secondsIn(measurements[i]);
    }
    EXPECT_GT(testing::count(output, wrong > 0 ? Verdict::Invalid : Verdict::Stale), 5u);
    testing::expectSameEstimates(expected, output, std::to_string(wrong));
  }
}

TEST(Clock, TheFirstStampMayBeTheWrongOne) {
  const auto scenario = testing::survey(40);
  const auto run = testing::simulate(scenario, 9);
  for (const double wrong : {-3600.0, 3600.0}) {
    auto measurements = run.measurements;
    measurements.front().stamp += stampFromSeconds(wrong);
    const auto output = feed("mixture_kf", testing::configFor(scenario), measurements);
    ASSERT_GT(output.solutions.size(), 500u) << wrong;
    EXPECT_LT(testing::positionError(output.solutions.back(), run), 4) << wrong;
  }
}

TEST(Clock, OneSensorWithAClockOfItsOwnIsRefused) {
  const auto scenario = testing::survey(40);
  const Config config = testing::configFor(scenario);
  std::vector<Measurement> mixed, without;
  for (auto z : testing::simulate(scenario, 10).measurements) {
    if (z.sensor == Sensor::Speed)
      z.stamp += stampFromSeconds(3600);
    else
      without.push_back(z);
    mixed.push_back(z);
  }
  const auto output = feed("robust_kf", config, mixed);
  EXPECT_EQ(testing::count(output, Verdict::Invalid), mixed.size() - without.size());
  testing::expectSameEstimates(feed("robust_kf", config, without), output, "without that sensor");
}

TEST(Clock, OrderWithinTheLagDoesNotMatterAfterALongGapEither) {
  const auto scenario = testing::survey(60);
  const Config config = testing::configFor(scenario);
  auto measurements = testing::simulate(scenario, 11).measurements;
  for (auto& z : measurements)
    if (secondsIn(z) > 30) z.stamp += stampFromSeconds(600);
  Random random = testing::announced(203);
  const auto in_order = feed("robust_kf", config, measurements);
  ASSERT_GT(in_order.solutions.size(), 1000u);
  for (int i = 0; i < 5; ++i) {
    std::vector<std::pair<Stamp, Measurement>> arrivals;
    for (const auto& z : measurements) arrivals.emplace_back(z.stamp + stampFromSeconds(4.9 * random.uniform()), z);
    std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Measurement> late;
    for (const auto& arrival : arrivals) late.push_back(arrival.second);
    testing::expectSameEstimates(in_order, feed("robust_kf", config, late), "shuffle");
  }
}

}  // namespace
}  // namespace sas_motion::towfish
