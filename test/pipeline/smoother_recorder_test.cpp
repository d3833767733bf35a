// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/smoother_recorder.hpp"

#include "pipeline/feeding.hpp"
#include "sas_motion/smoothers/rts.hpp"

namespace sas_motion::towfish {
namespace {

SmootherRecorder recorder(const Config& config) {
  return {config, [options = config.rts](const SmoothingProblem& problem) { return smoothRts(problem, options); }};
}

TEST(SmootherRecorder, OrderAndDuplicatesDoNotMatter) {
  const auto scenario = testing::survey(30);
  const Config config = testing::configFor(scenario);
  auto measurements = testing::simulate(scenario, 1).measurements;
  auto first = recorder(config);
  const auto in_order = testing::feed(first, measurements);
  std::reverse(measurements.begin(), measurements.end());
  measurements.insert(measurements.end(), measurements.begin(), measurements.begin() + 50);
  auto second = recorder(config);
  testing::expectSameEstimates(in_order, testing::feed(second, measurements), "reversed, some twice");
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
  const auto output = testing::feed(dirty, mixed);
  testing::expectSameEstimates(testing::feed(clean, good), output, "without the broken ones");
  EXPECT_EQ(testing::count(output, Verdict::Invalid), 2u);
}

TEST(SmootherRecorder, SaysWhyItCouldNotStart) {
  auto empty = recorder({});
  EXPECT_TRUE(testing::feed(empty, {}).estimates.empty());
  EXPECT_NE(empty.summary().failure, "");
  Measurement z;
  z.stamp = 1;
  auto single = recorder({});
  EXPECT_TRUE(testing::feed(single, {z}).estimates.empty());
  EXPECT_EQ(single.summary().failure, "no position and heading to start from");
}

TEST(SmootherRecorder, AuditsCarryTheSmoothedResidualsAndWeights) {
  const auto scenario = testing::zhu2007(40, testing::contaminated(0.1, 20));
  const Config config = testing::configFor(scenario);
  const auto run = testing::simulate(scenario, 3);
  auto smoother = recorder(config);
  const auto output = testing::feed(smoother, run.measurements);
  ASSERT_EQ(output.audits.size(), run.labelled.size());
  std::size_t flagged_outliers = 0, outliers = 0, flagged_good = 0;
  for (std::size_t i = 0; i < output.audits.size(); ++i) {
    ASSERT_EQ(output.audits[i].stamp, run.labelled[i].z.stamp);
    ASSERT_EQ(output.audits[i].sensor, run.labelled[i].z.sensor);
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
