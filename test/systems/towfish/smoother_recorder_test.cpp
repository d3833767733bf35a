// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/smoother_recorder.hpp"

#include "sas_motion/systems/towfish/rts.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

/// A recorder in its timeline.
struct Recorder {
  Recorder(const Config& config, SmootherRecorder::Solve solve)
      : estimator(new SmootherRecorder(config, std::move(solve))),
        timeline(testing::timelineOf(std::unique_ptr<Estimator>(estimator), config)) {}

  Output feed(const std::vector<Measurement>& measurements) { return testing::feed(*timeline, measurements); }

  SmootherRecorder* estimator;
  std::unique_ptr<testing::TowfishTimeline> timeline;
};

Recorder recorder(const Config& config) {
  return {config, [options = config.rts](const SmoothingProblem& problem) { return smoothRts(problem, options); }};
}

TEST(SmootherRecorder, OrderAndDuplicatesDoNotMatter) {
  const auto scenario = testing::survey(30);
  const Config config = testing::configFor(scenario);
  auto measurements = testing::simulate(scenario, 1).measurements;
  auto first = recorder(config);
  const auto in_order = first.feed(measurements);
  std::reverse(measurements.begin(), measurements.end());
  measurements.insert(measurements.end(), measurements.begin(), measurements.begin() + 50);
  auto second = recorder(config);
  testing::expectSameEstimates(in_order, second.feed(measurements), "reversed, some twice");
  testing::expectRisingStamps(in_order);
}

TEST(SmootherRecorder, BrokenMeasurementsAreCountedAndLeftOut) {
  const auto scenario = testing::survey(30);
  const Config config = testing::configFor(scenario);
  const auto good = testing::simulate(scenario, 2).measurements;
  auto mixed = good;
  Measurement bad = good[10];
  bad.value(0) = std::nan("");
  mixed.insert(mixed.begin() + 5, bad);
  bad = *std::find_if(good.begin() + 20, good.end(), [](const auto& z) { return z.sensor == Sensor::Position; });
  bad.variance.setConstant(-1);
  mixed.insert(mixed.begin() + 9, bad);
  auto clean = recorder(config), dirty = recorder(config);
  const auto output = dirty.feed(mixed);
  testing::expectSameEstimates(clean.feed(good), output, "without the broken ones");
  EXPECT_EQ(testing::count(output, Verdict::Invalid), 2u);
}

TEST(SmootherRecorder, SaysWhyItCouldNotStart) {
  auto empty = recorder({});
  EXPECT_TRUE(empty.feed({}).solutions.empty());
  EXPECT_NE(empty.estimator->summary().failure, "");
  Measurement z;
  z.stamp = 1;
  auto single = recorder({});
  EXPECT_TRUE(single.feed({z}).solutions.empty());
  EXPECT_EQ(single.estimator->summary().failure, "no position and heading to start from");
}

/// Reasons of the audits with a verdict.
std::vector<std::string> reasons(const Output& output, Verdict verdict) {
  std::vector<std::string> found;
  for (const auto& audit : output.audits)
    if (audit.verdict == verdict) found.emplace_back(audit.reason);
  return found;
}

TEST(SmootherRecorder, EveryMeasurementHasAnAuditInTimeOrder) {
  const auto scenario = testing::survey(30);
  auto measurements = testing::simulate(scenario, 4).measurements;
  std::vector<Measurement> early;  // nothing to start from
  for (int i = 0; i < 3; ++i) {
    early.push_back(*std::find_if(measurements.begin(), measurements.end(),
                                  [](const auto& z) { return z.sensor == Sensor::Speed; }));
    early.back().stamp -= stampFromSeconds(60 - i);
  }
  measurements.insert(measurements.end(), early.begin(), early.end());
  const auto twice = *std::find_if(measurements.begin() + 40, measurements.end(),
                                   [](const auto& z) { return z.sensor == Sensor::Heading; });
  measurements.insert(measurements.end(), {twice, twice});
  auto smoother = recorder(testing::configFor(scenario));
  const auto output = smoother.feed(measurements);
  EXPECT_EQ(reasons(output, Verdict::Stale), std::vector<std::string>(3, "before the first position and heading"));
  EXPECT_EQ(reasons(output, Verdict::Invalid), std::vector<std::string>(2, "duplicate stamp"));
  const auto inputs = std::count_if(measurements.begin(), measurements.end(),
                                    [](const auto& z) { return z.sensor == Sensor::TurnRate; });
  EXPECT_EQ(output.audits.size() + static_cast<std::size_t>(inputs),
            measurements.size());  // a turn rate that is used has none
  for (std::size_t i = 1; i < output.audits.size(); ++i)
    ASSERT_GE(output.audits[i].stamp, output.audits[i - 1].stamp) << i;
}

TEST(SmootherRecorder, WithoutASolutionEveryMeasurementIsRefused) {
  const auto scenario = testing::zhu2007(10);
  const auto measurements = testing::simulate(scenario, 5).measurements;
  Recorder broken(testing::configFor(scenario), [](const SmoothingProblem&) {
    SmootherResult result;
    result.failure = "broken";
    return result;
  });
  const auto output = broken.feed(measurements);
  EXPECT_TRUE(output.solutions.empty());
  EXPECT_EQ(broken.estimator->failure(), "broken");
  EXPECT_EQ(reasons(output, Verdict::Invalid),
            std::vector<std::string>(measurements.size(), "the smoother found no solution"));
  auto headings = measurements;
  headings.erase(
      std::remove_if(headings.begin(), headings.end(), [](const auto& z) { return z.sensor == Sensor::Position; }),
      headings.end());
  auto lost = recorder(testing::configFor(scenario));
  EXPECT_EQ(reasons(lost.feed(headings), Verdict::Stale).size(), headings.size());
}

TEST(SmootherRecorder, FinishingTwiceSaysNothingTwice) {
  const auto scenario = testing::zhu2007(20);
  const auto measurements = testing::simulate(scenario, 6).measurements;
  auto smoother = recorder(testing::configFor(scenario));
  EXPECT_FALSE(smoother.feed(measurements).solutions.empty());
  EXPECT_EQ(smoother.estimator->failure(), "");
  const auto again = smoother.feed({});
  EXPECT_TRUE(again.solutions.empty());
  EXPECT_TRUE(again.audits.empty());
  EXPECT_EQ(smoother.estimator->failure(), "nothing new since the last solution");
}

TEST(SmootherRecorder, MoreDataAfterTheEndAreSolvedWithAllBeforeThem) {
  const auto scenario = testing::zhu2007(40);
  const auto measurements = testing::simulate(scenario, 7).measurements;
  const auto half = measurements.begin() + static_cast<std::ptrdiff_t>(measurements.size() / 2);
  auto smoother = recorder(testing::configFor(scenario)), whole = recorder(testing::configFor(scenario));
  smoother.feed({measurements.begin(), half});
  const auto all = whole.feed(measurements);
  testing::expectSameEstimates(smoother.feed({half, measurements.end()}), all, "in two parts");
}

TEST(SmootherRecorder, AuditsCarryTheSmoothedResidualsAndWeights) {
  const auto scenario = testing::zhu2007(40, testing::contaminated(0.1, 20));
  const Config config = testing::configFor(scenario);
  const auto run = testing::simulate(scenario, 3);
  auto smoother = recorder(config);
  const auto output = smoother.feed(run.measurements);
  ASSERT_EQ(output.audits.size(), run.labelled.size());
  std::size_t flagged_outliers = 0, outliers = 0, flagged_good = 0;
  for (std::size_t i = 0; i < output.audits.size(); ++i) {
    ASSERT_EQ(output.audits[i].stamp, run.labelled[i].z.stamp);
    ASSERT_EQ(output.audits[i].sensor, sensorName(run.labelled[i].z.sensor));
    const bool outlier = run.labelled[i].outlier[0] || run.labelled[i].outlier[1];
    const bool flagged = output.audits[i].verdict == Verdict::DownWeighted;
    outliers += outlier;
    flagged_outliers += outlier && flagged;
    flagged_good += !outlier && flagged;
  }
  EXPECT_GT(static_cast<double>(flagged_outliers), 0.8 * static_cast<double>(outliers));
  EXPECT_LT(static_cast<double>(flagged_good), 0.05 * static_cast<double>(output.audits.size()));
}

}  // namespace
}  // namespace sas_motion::towfish
