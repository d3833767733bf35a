// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A state that is set from outside, and settings that change on the way.
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

using testing::feed;

constexpr Stamp kWhen = Simulator::kStart + 20 * kNanosecondsPerSecond;

class Control : public ::testing::TestWithParam<std::string> {};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(EveryFilter, Control, ::testing::ValuesIn(testing::filterNames()), nameOf);

/// A state far away, of which there is no doubt.
Estimate elsewhere(Stamp stamp) {
  Estimate state;
  state.stamp = stamp;
  state.belief.mean << 1e4, -1e4, 0.1, 0.2, 0.5, 3;
  state.belief.covariance = 1e-4 * StateMatrix::Identity();
  return state;
}

TEST_P(Control, ASetStateIsTheStateAtItsStampAndWhatCameLaterIsFusedOnIt) {
  const auto scenario = testing::survey(40);
  const Config config = testing::configFor(scenario);
  const auto measurements = testing::simulate(scenario, 21).measurements;
  const auto estimator = testing::timelineOf(GetParam(), config), untouched = testing::timelineOf(GetParam(), config);
  bool done = false;
  Output output, expected;
  for (const auto& z : measurements) {
    untouched->process(z, expected);
    estimator->process(z, output);
    if (done || z.stamp < kWhen + 2 * kNanosecondsPerSecond) continue;
    done = true;
    EXPECT_EQ(estimator->setState(elsewhere(kWhen), output), nullptr);  // two seconds ago
    EXPECT_EQ(estimator->at(kWhen)->belief.mean, elsewhere(kWhen).belief.mean);
    const auto now = *estimator->current();
    EXPECT_EQ(now.stamp, z.stamp);
    EXPECT_LT((now.belief.mean - elsewhere(kWhen).belief.mean).head<2>().norm(), 300);
    EXPECT_EQ(estimator->at(kWhen - 1), std::nullopt);
  }
  estimator->finish(output);
  testing::expectRisingStamps(output);
  for (std::size_t i = 0; output.solutions[i].stamp < kWhen; ++i)
    ASSERT_EQ(output.solutions[i].belief.mean, expected.solutions[i].belief.mean);
}

TEST_P(Control, ASetStateReplacesTheStart) {
  const auto measurements = testing::simulate(testing::survey(10), 22).measurements;
  const auto estimator = testing::timelineOf(GetParam(), testing::configFor(testing::survey(10)));
  Output output;
  EXPECT_EQ(estimator->setState(elsewhere(measurements.front().stamp - 1), output), nullptr);
  estimator->process(measurements.front(), output);
  ASSERT_TRUE(estimator->current());  // without waiting for the window
  EXPECT_LT((estimator->current()->belief.mean - elsewhere(0).belief.mean).norm(), 100);
}

TEST(Control, AStampThatIsSettledOrFarAwayIsRefused) {
  const auto scenario = testing::survey(30);
  const auto estimator = testing::timelineOf("kf", testing::configFor(scenario));
  Output output = feed(*estimator, testing::simulate(scenario, 23).measurements);
  const auto before = estimator->current();
  ASSERT_TRUE(before);
  EXPECT_STREQ(estimator->setState(elsewhere(before->stamp - kNanosecondsPerSecond), output),
               "the stamp is older than the lag");
  EXPECT_STREQ(estimator->setState(elsewhere(before->stamp + 3600 * kNanosecondsPerSecond), output),
               "the stamp is far from those of the measurements");
  EXPECT_EQ(estimator->current()->belief.mean, before->belief.mean);
  EXPECT_EQ(estimator->setState(elsewhere(before->stamp), output), nullptr);
  EXPECT_STREQ(testing::timelineOf("rts", {})->setState(elsewhere(before->stamp), output), "it keeps no present state");
}

TEST(Control, OtherSettingsCountFromTheNextMeasurementOnAndNotInAReplay) {
  auto scenario = testing::survey(40);
  for (auto& sensor : scenario.sources) sensor.noise = testing::contaminated(0.2, 20);
  Config config = testing::configFor(scenario), changed = config;
  changed.filters.robust_kf.loss = Loss(LossKind::L2);
  const auto measurements = testing::simulate(scenario, 24).measurements;
  const auto straight = testing::timelineOf("robust_kf", config), estimator = testing::timelineOf("robust_kf", config);
  Output expected, output;
  std::size_t compared = 0;
  Measurement late;
  bool done = false;
  Stamp change = 0;
  for (const auto& z : measurements) {
    if (z.sensor == Sensor::Speed && secondsBetween(z.stamp, kWhen) > 0 && secondsBetween(z.stamp, kWhen) < 0.2) {
      late = z;  // held back: it makes the others be replayed
      continue;
    }
    straight->process(z, expected);
    estimator->process(z, output);
    if (!done && z.stamp >= kWhen) {
      done = true;
      change = z.stamp;
      estimator->configure(changed);
      straight->process(late, expected);
      estimator->process(late, output);
    }
    if (z.stamp < kWhen) {
      const auto a = straight->current(), b = estimator->current();
      ASSERT_EQ(a.has_value(), b.has_value());
      compared += a.has_value();
    }
  }
  straight->finish(expected);
  estimator->finish(output);
  ASSERT_GT(compared, 100u);
  bool differs = false;
  for (std::size_t i = 0; i < output.solutions.size(); ++i) {
    const bool same = output.solutions[i].belief.mean == expected.solutions[i].belief.mean;
    ASSERT_TRUE(same || output.solutions[i].stamp >= late.stamp) << i;
    differs = differs || !same;
  }
  EXPECT_TRUE(differs);
  std::size_t replayed = 0;  // came before the change, fused again after it: still by Huber's loss
  for (const auto& audit : output.audits)
    replayed += audit.stamp > late.stamp && audit.stamp <= change && audit.iterations > 1;
  EXPECT_GT(replayed, 0u);
  for (const auto& audit : output.audits) EXPECT_TRUE(audit.stamp <= change || audit.verdict != Verdict::DownWeighted);
}

}  // namespace
}  // namespace sas_motion::towfish
