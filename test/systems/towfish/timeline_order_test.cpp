// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is settled depends on the measurements and not on the order in which they arrived.
#include <algorithm>

#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

using testing::feed;

/// Measurements in the order in which they arrive when each is up to `longest` seconds late, some of them twice.
std::vector<Measurement> shuffled(const std::vector<Measurement>& measurements, double longest, double twice,
                                  Random& random) {
  std::vector<std::pair<Stamp, Measurement>> arrivals;
  for (const auto& z : measurements) {
    arrivals.emplace_back(z.stamp + stampFromSeconds(longest * random.uniform()), z);
    if (random.bernoulli(twice)) arrivals.emplace_back(z.stamp + stampFromSeconds(longest * random.uniform()), z);
  }
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Measurement> order;
  for (const auto& arrival : arrivals) order.push_back(arrival.second);
  return order;
}

class Order : public ::testing::TestWithParam<std::string> {};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(EveryFilter, Order, ::testing::ValuesIn(testing::filterNames()), nameOf);

TEST_P(Order, LateAndRepeatedMeasurementsChangeNothing) {
  auto scenario = testing::survey(40);
  for (auto& sensor : scenario.sources) sensor.noise = testing::contaminated(0.2, 20);
  const Config config = testing::configFor(scenario);
  Random random = testing::announced(201);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto measurements = testing::simulate(scenario, seed).measurements;
    const auto in_order = feed(GetParam(), config, measurements);
    ASSERT_GT(in_order.solutions.size(), 300u);
    for (const double longest : {0.05, 1.0, 4.9}) {
      const auto late = feed(GetParam(), config, shuffled(measurements, longest, 0.1, random));
      EXPECT_EQ(testing::count(late, Verdict::Stale), 0u);
      testing::expectSameEstimates(in_order, late,
                                   "seed " + std::to_string(seed) + ", late by " + std::to_string(longest));
    }
  }
}

TEST(Order, TheLateStartOfASensorDoesNotMatterEither) {
  const auto scenario = testing::survey(40);
  const Config config = testing::configFor(scenario);
  auto measurements = testing::simulate(scenario, 4).measurements;
  const Stamp fix = Simulator::kStart + stampFromSeconds(12);
  measurements.erase(std::remove_if(measurements.begin(), measurements.end(),
                                    [&](const auto& z) { return z.sensor == Sensor::Position && z.stamp < fix; }),
                     measurements.end());
  const auto in_order = feed("robust_kf", config, measurements);
  ASSERT_GT(in_order.solutions.size(), 200u);
  Random random = testing::announced(202);
  for (int i = 0; i < 5; ++i)
    testing::expectSameEstimates(in_order, feed("robust_kf", config, shuffled(measurements, 4.9, 0.1, random)),
                                 "shuffle");
}

TEST(Order, ExactDuplicatesAreReportedOnce) {
  const auto scenario = testing::survey(30);
  const Config config = testing::configFor(scenario);
  const auto measurements = testing::simulate(scenario, 5).measurements;
  auto doubled = measurements;
  for (std::size_t i = 0; i < measurements.size(); ++i)
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(2 * i), measurements[i]);
  const auto once = feed("robust_kf", config, measurements), twice = feed("robust_kf", config, doubled);
  testing::expectSameEstimates(once, twice, "doubled");
  EXPECT_EQ(testing::count(twice, Verdict::Invalid), measurements.size());
}

TEST(Order, OlderThanTheLagIsStaleAndChangesNothing) {
  const auto scenario = testing::survey(40);
  Config config = testing::configFor(scenario);
  auto measurements = testing::simulate(scenario, 6).measurements;
  std::vector<Measurement> kept, order;
  std::size_t held_back = 0;
  std::vector<Measurement> waiting;
  for (const auto& z : measurements) {
    const bool hold = z.sensor == Sensor::Position && secondsBetween(Simulator::kStart, z.stamp) > 20 &&
                      z.stamp % (3 * kNanosecondsPerSecond) < kNanosecondsPerSecond;
    if (hold) {
      waiting.push_back(z);
      ++held_back;
    } else {
      kept.push_back(z);
      order.push_back(z);
    }
    while (!waiting.empty() && secondsBetween(waiting.front().stamp, z.stamp) > config.lag + 0.2) {
      order.push_back(waiting.front());
      waiting.erase(waiting.begin());
    }
  }
  const std::size_t late = held_back - waiting.size();
  ASSERT_GT(late, 3u);
  const auto output = feed("robust_kf", config, order);
  EXPECT_EQ(testing::count(output, Verdict::Stale), late);
  testing::expectSameEstimates(feed("robust_kf", config, kept), output, "without the late ones");
}

TEST(Order, EstimatesComeInTimeOrderOnceAStamp) {
  const auto scenario = testing::survey(30);
  const auto estimator = testing::timelineOf("robust_kf", testing::configFor(scenario));
  const auto measurements = testing::simulate(scenario, 7).measurements;
  Output output;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    estimator->process(measurements[i], output);
    if (i % 150 == 149) estimator->finish(output);  // pauses
  }
  estimator->finish(output);
  testing::expectRisingStamps(output);
}

}  // namespace
}  // namespace sas_motion::towfish
