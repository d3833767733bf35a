// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/fixed_lag.hpp"

#include <cmath>

#include "sas_motion/systems/towfish/rts.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

Config configWithLag(const Scenario& scenario, double lag) {
  Config config = testing::configFor(scenario);
  config.fixed_lag.lag = lag;
  return config;
}

/// A fixed-lag smoother in its timeline.
struct FixedLag {
  explicit FixedLag(const Config& config)
      : estimator(new FixedLagSmoother(config)),
        timeline(testing::timelineOf(std::unique_ptr<Estimator>(estimator), config)) {}

  FixedLagSmoother* estimator;
  std::unique_ptr<testing::TowfishTimeline> timeline;
};

/// RMS over time of each state's distance from the batch answer, in the batch's standard deviations.
StateVector distanceFromBatch(const Output& output, const Config& config,
                              const std::vector<Measurement>& measurements) {
  const auto problem = *buildProblem(measurements, config);
  const auto batch = smoothRts(problem, {config.fixed_lag.loss, 500, 1e-12});
  StateVector squares = StateVector::Zero();
  EXPECT_EQ(output.solutions.size(), problem.nodes());
  for (std::size_t k = 0; k < std::min(problem.nodes(), output.solutions.size()); ++k) {
    EXPECT_EQ(output.solutions[k].stamp, problem.stamps[k]);
    const StateVector sigma = batch.states[k].covariance.diagonal().cwiseSqrt();
    squares +=
        Model::difference(output.solutions[k].belief.mean, batch.states[k].mean).cwiseQuotient(sigma).cwiseAbs2();
  }
  return (squares / static_cast<double>(problem.nodes())).cwiseSqrt();
}

TEST(FixedLag, WithALagLongerThanTheDataItIsTheBatchSmoother) {
  const auto scenario = testing::zhu2007(40, testing::contaminated(0.1, 10));
  std::cout << "seed 1\n";
  const auto measurements = testing::simulate(scenario, 1).measurements;
  const Config config = configWithLag(scenario, 100);
  FixedLag smoother(config);
  const auto output = testing::feed(*smoother.timeline, measurements);
  EXPECT_EQ(smoother.estimator->rebuilds(), 0);
  EXPECT_LT(distanceFromBatch(output, config, measurements).maxCoeff(), 0.05);
}

TEST(FixedLag, TenSecondsOfLagAreNearlyTheBatchSmoother) {
  const auto scenario = testing::zhu2007(60, testing::contaminated(0.1, 10));
  std::cout << "seed 2\n";
  const auto measurements = testing::simulate(scenario, 2).measurements;
  const Config config = configWithLag(scenario, 10);
  FixedLag smoother(config);
  const auto output = testing::feed(*smoother.timeline, measurements);
  EXPECT_EQ(smoother.estimator->rebuilds(), 0);
  const StateVector distance = distanceFromBatch(output, config, measurements);
  EXPECT_LT(distance(kHeading), 0.1) << distance.transpose();
  EXPECT_LT(distance(kSpeed), 0.1) << distance.transpose();
  EXPECT_LT(distance.head<2>().maxCoeff(), 0.5)
      << distance.transpose();  // the current is learned over more than ten seconds
}

TEST(FixedLag, ArrivalOrderWithinTheReorderTimeDoesNotMatter) {
  const auto scenario = testing::survey(25);
  Config config = configWithLag(scenario, 5);
  config.fixed_lag.reorder = 1;
  const auto measurements = testing::simulate(scenario, 3).measurements;
  Random random = testing::announced(311);
  std::vector<std::pair<Stamp, Measurement>> arrivals;
  for (const auto& z : measurements) arrivals.emplace_back(z.stamp + stampFromSeconds(0.95 * random.uniform()), z);
  std::sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Measurement> shuffled;
  for (const auto& arrival : arrivals) shuffled.push_back(arrival.second);
  FixedLag first(config), second(config);
  const auto in_order = testing::feed(*first.timeline, measurements), late = testing::feed(*second.timeline, shuffled);
  EXPECT_EQ(testing::count(late, Verdict::Stale), 0u);
  testing::expectSameEstimates(in_order, late, "shuffled");
}

TEST(FixedLag, PutsOutEachStampOnceThroughPauses) {
  const auto scenario = testing::survey(25);
  FixedLag smoother(configWithLag(scenario, 5));
  const auto measurements = testing::simulate(scenario, 4).measurements;
  Output output;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    smoother.timeline->process(measurements[i], output);
    if (i % 200 == 199) smoother.timeline->finish(output);
  }
  smoother.timeline->finish(output);
  smoother.timeline->finish(output);
  testing::expectRisingStamps(output);
  std::size_t fused = 0;
  for (const auto& z : measurements) fused += rowsOf(z.sensor) > 0;
  EXPECT_EQ(output.audits.size(), fused);
}

TEST(FixedLag, SurvivesWhatItsSolverCannotSolve) {
  const auto scenario = testing::survey(25);
  auto run = testing::simulate(scenario, 5);
  auto measurements = run.measurements;
  for (std::size_t i = 300; i < 340; ++i)
    measurements[i].variance.setConstant(1e-24);  // more than its Cholesky can hold
  for (std::size_t i = measurements.size() - 5; i < measurements.size(); ++i)
    measurements[i].variance.setConstant(1e-24);
  FixedLag smoother(configWithLag(scenario, 5));
  Output output;
  EXPECT_NO_THROW(output = testing::feed(*smoother.timeline, measurements));
  EXPECT_GT(smoother.estimator->rebuilds(), 0);
  ASSERT_GT(output.solutions.size(), 100u);
  testing::expectRisingStamps(output);
  for (const auto& estimate : output.solutions) ASSERT_TRUE(estimate.belief.mean.allFinite());
}

TEST(FixedLag, BrokenMeasurementsAreCountedAndChangeNothing) {
  const auto scenario = testing::survey(20);
  const Config config = configWithLag(scenario, 5);
  const auto good = testing::simulate(scenario, 6).measurements;
  auto mixed = good;
  Measurement bad = good[50];
  bad.value(0) = std::nan("");
  mixed.insert(mixed.begin() + 40, bad);
  bad = good[0];  // a position or a heading, long past
  mixed.insert(mixed.begin() + 300, bad);
  FixedLag clean(config), dirty(config);
  const auto output = testing::feed(*dirty.timeline, mixed);
  testing::expectSameEstimates(testing::feed(*clean.timeline, good), output, "without the broken ones");
  EXPECT_EQ(testing::count(output, Verdict::Invalid), 1u);
  EXPECT_EQ(testing::count(output, Verdict::Stale), 1u);
}

TEST(FixedLag, RecoversFromAClockThatIsSetWithinFiveSecondsOfData) {
  const auto scenario = testing::survey(45);
  const auto run = testing::simulate(scenario, 8);
  Config config = configWithLag(scenario, 5);
  for (const double jump : {1.0, -1.0, 3600.0, -3600.0, 3.15e8, -3.15e8}) {
    FixedLag smoother(config);
    Output output;
    for (const auto& z : run.measurements) {
      const double t = secondsBetween(Simulator::kStart, z.stamp);
      Measurement moved = z;
      if (t > 30) moved.stamp += stampFromSeconds(jump);
      smoother.timeline->process(moved, output);
      if (t < 35) continue;
      auto now = smoother.timeline->current();
      ASSERT_TRUE(now) << jump << " s, at " << t;
      now->stamp -= stampFromSeconds(jump);
      ASSERT_GE(secondsBetween(now->stamp, z.stamp), 0) << jump << " s, at " << t;
      ASSERT_LT(secondsBetween(now->stamp, z.stamp), config.fixed_lag.reorder + 1) << jump << " s, at " << t;
      ASSERT_LT(testing::positionError(*now, run), 4) << jump << " s, at " << t;
    }
  }
}

TEST(FixedLag, OneWrongStampChangesNothing) {
  const auto scenario = testing::survey(25);
  const Config config = configWithLag(scenario, 5);
  const auto good = testing::simulate(scenario, 9).measurements;
  for (const double wrong : {-3600.0, 3600.0, 3.15e8}) {
    auto mixed = good;
    Measurement bad = good[100];
    bad.stamp += stampFromSeconds(wrong);
    mixed.insert(mixed.begin() + 100, bad);
    FixedLag clean(config), dirty(config);
    testing::expectSameEstimates(testing::feed(*clean.timeline, good), testing::feed(*dirty.timeline, mixed),
                                 std::to_string(wrong));
  }
}

TEST(FixedLag, StartsAgainFromAStateThatIsSet) {
  const auto scenario = testing::survey(40);
  const auto run = testing::simulate(scenario, 10);
  FixedLag smoother(configWithLag(scenario, 5));
  Output output;
  bool done = false;
  for (const auto& z : run.measurements) {
    smoother.timeline->process(z, output);
    if (done || secondsBetween(Simulator::kStart, z.stamp) < 20) continue;
    done = true;
    const auto now = smoother.timeline->current();
    ASSERT_TRUE(now);
    Estimate set{z.stamp, now->belief};
    set.belief.mean.head<2>().setConstant(1e4);
    set.belief.covariance = StateMatrix::Identity() * 1e-6;
    EXPECT_EQ(smoother.timeline->setState(set, output), nullptr);
    set.stamp -= stampFromSeconds(10);
    EXPECT_STREQ(smoother.timeline->setState(set, output), "the stamp is older than the lag");
  }
  smoother.timeline->finish(output);
  testing::expectRisingStamps(output);
  std::size_t after = 0;
  for (const auto& estimate : output.solutions) {
    const double t = secondsBetween(Simulator::kStart, estimate.stamp);
    if (t < 20) {
      ASSERT_LT(testing::positionError(estimate, run), 5) << t;
    }
    if (t < 20.1 || t > 22) continue;
    ++after;
    ASSERT_NEAR(estimate.belief.mean(kNorth), 1e4, 100) << t;
  }
  EXPECT_GT(after, 20u);
}

TEST(FixedLag, ThePresentIsAtTheNewestMeasurementAndAStateCanBeAskedFor) {
  const auto scenario = testing::survey(25);
  const auto run = testing::simulate(scenario, 12);
  FixedLag smoother(configWithLag(scenario, 5));
  Output output;
  std::size_t compared = 0;
  for (const auto& z : run.measurements) {
    smoother.timeline->process(z, output);
    if (secondsBetween(Simulator::kStart, z.stamp) < 15) continue;
    const auto& now = smoother.timeline->current();
    ASSERT_TRUE(now);
    ASSERT_EQ(now->stamp, z.stamp);
    ASSERT_LT(testing::positionError(*now, run), 4);
    const auto asked = smoother.timeline->at(z.stamp), earlier = smoother.timeline->at(z.stamp - stampFromSeconds(1));
    ASSERT_TRUE(asked && earlier);
    ASSERT_EQ(asked->belief.mean, now->belief.mean);
    ASSERT_LT(testing::positionError(*earlier, run), 4);
    ++compared;
  }
  EXPECT_GT(compared, 200u);
}

TEST(FixedLag, AnotherLossCountsFromTheNextMeasurementOn) {
  const auto scenario = testing::survey(40);
  auto measurements = testing::simulate(scenario, 11).measurements;
  Config config = configWithLag(scenario, 5);
  for (auto& z : measurements)
    if (z.sensor == Sensor::Position && z.stamp % (7 * kNanosecondsPerSecond) < kNanosecondsPerSecond) z.value(0) += 30;
  FixedLag one(config), other(config);
  Output expected, output;
  for (const auto& z : measurements) {
    if (secondsBetween(Simulator::kStart, z.stamp) >= 20 && config.fixed_lag.loss.kind() != LossKind::L2) {
      config.fixed_lag.loss = Loss(LossKind::L2);
      other.timeline->configure(config);
    }
    one.timeline->process(z, expected);
    other.timeline->process(z, output);
  }
  std::size_t before = 0, differ = 0;
  for (std::size_t i = 0; i < std::min(expected.solutions.size(), output.solutions.size()); ++i) {
    const bool same = expected.solutions[i].belief.mean == output.solutions[i].belief.mean;
    const double t = secondsBetween(Simulator::kStart, expected.solutions[i].stamp);
    ASSERT_TRUE(same || t >= 12) << t;  // settled before the change
    before += t < 12;
    differ += !same;
  }
  EXPECT_GT(before, 100u);
  EXPECT_GT(differ, 100u);
}

}  // namespace
}  // namespace sas_motion::towfish
