// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "systems/ins_gps_dvl/stream.hpp"

namespace sas_motion::ins {
namespace {

using namespace testing;

bool same(const NavigationSolution& a, const NavigationSolution& b) {
  return a.stamp == b.stamp && a.state.latitude == b.state.latitude && a.state.longitude == b.state.longitude &&
         a.state.height == b.state.height && a.state.velocity_nav == b.state.velocity_nav &&
         a.state.q_nav_body.coeffs() == b.state.q_nav_body.coeffs() && *a.covariance == *b.covariance;
}

/// The first part of a stream, whose last reading is of the IMU.
std::vector<Reading> until(std::vector<Reading> stream, double time) {
  while (!isInertial(stream.back()) || stampOf(stream.back()) > kEpoch + stampFromSeconds(time)) stream.pop_back();
  return stream;
}

TEST(InsPresent, ThePresentIsWhatSettlesLater) {
  const Scenario scenario = surveyOf(40);
  const auto stream = streamOf(scenario, 1);
  EstimatorRun live(optionsOf(scenario), "kf27", true);
  std::vector<NavigationSolution> present;
  for (const auto& reading : stream) {
    live.process(reading);
    if (isInertial(reading) && live.timeline.current() && live.timeline.current()->stamp == stampOf(reading))
      present.push_back(*live.timeline.current());
  }
  live.finish();
  const auto& solutions = live.output.solutions;
  ASSERT_GT(present.size(), 3600u);
  ASSERT_LT(present.size(), solutions.size());  // it is there a lag after the start
  for (std::size_t i = 1; i <= present.size(); ++i)
    ASSERT_TRUE(same(present[present.size() - i], solutions[solutions.size() - i])) << i;
}

TEST(InsPresent, AnyOrderInsideTheLagGivesTheSamePresent) {
  const Scenario scenario = surveyOf(40);
  const auto stream = until(streamOf(scenario, 2), 37.43);
  EstimatorRun sorted(optionsOf(scenario), "robust_kf27", true), late(optionsOf(scenario), "robust_kf27", true);
  sorted.process(stream);
  late.process(shuffled(stream, 1.9));
  ASSERT_TRUE(sorted.timeline.current() && late.timeline.current());
  EXPECT_EQ(sorted.timeline.current()->stamp, stampOf(stream.back()));
  EXPECT_TRUE(same(*sorted.timeline.current(), *late.timeline.current()));
}

TEST(InsPresent, StatesAtPingTimesAreThoseOfTheMotion) {
  // GIVEN a run in waves, WHEN states are asked for between the stamps of the IMU, THEN their errors are
  // those at the stamps around them.
  Scenario scenario = surveyOf(40);
  EstimatorRun live(optionsOf(scenario), "kf27", true);
  live.process(streamOf(scenario, 1));
  const Trajectory trajectory(scenario.track, scenario.duration);
  const auto error = [&](double time) {
    const auto solution = live.timeline.at(kEpoch + stampFromSeconds(time));
    EXPECT_TRUE(solution.has_value()) << time;
    const NavigationState truth = trajectory.at(time).state;
    return std::pair(displacement(truth, solution->state), attitudeError(solution->state.q_nav_body, truth.q_nav_body));
  };
  double worst_position = 0, worst_attitude = 0;
  for (double time = 38.3; time < 39.9; time += 0.1) {
    const auto at = error(time), after = error(time + 0.01);
    for (const double part : {0.0013, 0.005, 0.0087}) {
      const auto between = error(time + part);
      const double share = part / 0.01;  // the errors themselves change slowly
      worst_position = std::max(worst_position, (between.first - at.first - share * (after.first - at.first)).norm());
      worst_attitude =
          std::max(worst_attitude, (between.second - at.second - share * (after.second - at.second)).norm());
    }
  }
  std::cout << "between stamps: " << 1e6 * worst_position << " um, " << 1e6 * worst_attitude << " urad\n";
  EXPECT_LT(worst_position, 1e-6);
  EXPECT_LT(worst_attitude, 5e-6);
}

TEST(InsPresent, StatesAtItsStampsAreItsSolutionsAndThoseOutsideAreNone) {
  const Scenario scenario = surveyOf(40);
  const auto stream = until(streamOf(scenario, 1), 35);
  EstimatorRun live(optionsOf(scenario), "kf27", true);
  std::vector<NavigationSolution> present;
  for (const auto& reading : stream) {
    live.process(reading);
    if (isInertial(reading) && live.timeline.current()) present.push_back(*live.timeline.current());
  }
  for (std::size_t i = 1; i < 190; i += 7) {
    const NavigationSolution& asked = present[present.size() - i];
    const auto answer = live.timeline.at(asked.stamp);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(same(*answer, asked)) << i;
  }
  const Stamp newest = present.back().stamp;
  EXPECT_FALSE(live.timeline.at(newest - 3 * kNanosecondsPerSecond));
  EXPECT_FALSE(live.timeline.at(newest + 2 * kNanosecondsPerSecond));
  const auto ahead = live.timeline.at(newest + kNanosecondsPerSecond / 2);
  ASSERT_TRUE(ahead);
  EXPECT_GT((*ahead->covariance)(0, 0), (*present.back().covariance)(0, 0));
  const TruthSample truth = Trajectory(scenario.track, scenario.duration).at(35.5);
  const TruthSample before = Trajectory(scenario.track, scenario.duration).at(35);
  const Vector<3> drift = displacement(truth.state, ahead->state) - displacement(before.state, present.back().state);
  EXPECT_LT(drift.norm(), 0.2);
}

}  // namespace
}  // namespace sas_motion::ins
