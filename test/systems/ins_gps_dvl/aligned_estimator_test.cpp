// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support.hpp"
#include "systems/ins_gps_dvl/stream.hpp"

namespace sas_motion::ins {
namespace {

using namespace testing;
using Lack = Alignment::Lack;

bool operator==(const NavigationState& a, const NavigationState& b) {
  return a.latitude == b.latitude && a.longitude == b.longitude && a.height == b.height &&
         a.velocity_nav == b.velocity_nav && a.q_nav_body.coeffs() == b.q_nav_body.coeffs();
}

/// Bit for bit.
void expectSame(const Output& a, const Output& b) {
  ASSERT_EQ(a.solutions.size(), b.solutions.size());
  ASSERT_EQ(a.audits.size(), b.audits.size());
  for (std::size_t i = 0; i < a.solutions.size(); ++i) {
    ASSERT_EQ(a.solutions[i].stamp, b.solutions[i].stamp);
    ASSERT_TRUE(a.solutions[i].state == b.solutions[i].state) << i;
    ASSERT_EQ(*a.solutions[i].covariance, *b.solutions[i].covariance) << i;
  }
  for (std::size_t i = 0; i < a.audits.size(); ++i) ASSERT_EQ(a.audits[i].nis, b.audits[i].nis) << i;
}

double positionError(const Scenario& scenario, const NavigationSolution& solution) {
  const TruthSample truth = Trajectory(scenario.track, scenario.duration).at(secondsBetween(kEpoch, solution.stamp));
  return displacement(truth.state, solution.state).norm();
}

Lack lackOf(const std::vector<Reading>& stream, const SessionOptions& options) {
  EstimatorRun session(options);
  session.process(stream);
  session.finish();
  EXPECT_TRUE(session.output.solutions.empty());
  return session.estimator->alignment().lack();
}

TEST(InsSession, StartsAtTheFirstFixAfterAttitudeAndVelocity) {
  const Scenario scenario = surveyOf(20);
  const Output output = settled(streamOf(scenario, 1), optionsOf(scenario));
  ASSERT_FALSE(output.solutions.empty());
  EXPECT_EQ(output.solutions.front().stamp, kEpoch + kNanosecondsPerSecond);  // the fix of the first second
  EXPECT_EQ(output.audits.front().verdict, Verdict::Stale);
  EXPECT_EQ(output.audits.front().reason, "before the start");
  // The fix is fused at once, with the uncertainty that it has.
  const Parameters& p = scenario.parameters;
  const Matrix<9>& P = *output.solutions.front().covariance;
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = std::hypot(p.gps_markov(axis), p.gps_white(axis));
    EXPECT_NEAR(std::sqrt(P(kPosition + axis, kPosition + axis)), sigma, axis == 2 ? sigma : 0.02 * sigma) << axis;
  }
  EXPECT_LT(positionError(scenario, output.solutions.front()), 4 * 5.1);
}

TEST(InsSession, TheStartIsConsistentOverManyRuns) {
  // GIVEN 60 runs that start from their own fixes, WHEN a minute has passed, THEN the errors are what the covariance
  // says.
  const Scenario scenario = surveyOf(60);
  double position = 0, velocity = 0, attitude = 0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const NavigationSolution last = settled(streamOf(scenario, seed), optionsOf(scenario)).solutions.back();
    const TruthSample truth = Trajectory(scenario.track, scenario.duration).at(secondsBetween(kEpoch, last.stamp));
    const auto nees = [&](const Vector<3>& error, int first) {
      return error.dot(last.covariance->block<3, 3>(first, first).llt().solve(error)) / kRuns;
    };
    position += nees(displacement(truth.state, last.state), kPosition);
    velocity += nees(last.state.velocity_nav - truth.state.velocity_nav, kVelocity);
    attitude += nees(attitudeError(last.state.q_nav_body, truth.state.q_nav_body), kAttitude);
  }
  const Band band = averageChiSquaredBand(3, kRuns, 0.999);
  for (const double nees : {position, velocity, attitude}) {
    EXPECT_GT(nees, band.lower);
    EXPECT_LT(nees, band.upper);
  }
}

TEST(InsSession, SaysWhatTheStartLacks) {
  const Scenario scenario = surveyOf(15);
  const auto stream = streamOf(scenario, 1);
  const auto options = optionsOf(scenario);
  EXPECT_EQ(lackOf(without(stream, isInertial), options), Lack::InertialUnit);
  EXPECT_EQ(lackOf(without(stream, [](const Reading& r) { return isOf(r, Sensor::Gps); }), options), Lack::Fix);
  auto blind = stream;
  for (auto& reading : blind)
    if (auto* inertial = std::get_if<InertialReading>(&reading)) inertial->attitude.reset();
  EXPECT_EQ(lackOf(blind, options), Lack::Attitude);
  auto patient = options;
  patient.alignment.velocity_wait = 60;
  EXPECT_EQ(lackOf(without(stream, [](const Reading& r) { return isOf(r, Sensor::Dvl); }), patient), Lack::Velocity);
  const auto early = [](const Reading& r) {
    return isInertial(r) ? stampOf(r) < kEpoch + 5 * kNanosecondsPerSecond
                         : stampOf(r) > kEpoch + 4 * kNanosecondsPerSecond;
  };
  EXPECT_EQ(lackOf(without(stream, early), options), Lack::FixAfterAttitude);
}

/// Where a stream starts.
Start startOf(const std::vector<Reading>& stream, const SessionOptions& options) {
  Alignment alignment(options.alignment, options.config.parameters);
  std::vector<Event> events;
  for (const auto& reading : stream) alignment.take(reading, events);
  for (const auto& event : events)
    if (const auto* start = std::get_if<Start>(&event)) return *start;
  ADD_FAILURE() << "no start";
  return {};
}

TEST(InsSession, AVelocityOfGnssStartsItAsSurelyAsItSays) {
  // GIVEN GNSS that knows the velocity at the moment of its fix, WHEN there is a DVL or none, THEN the start has
  // GNSS's, in time order after all
  const Scenario scenario = surveyOf(3);
  const GroundVelocity velocity{kEpoch + kNanosecondsPerSecond, Vector<3>(1, 2, 3), 0.07};
  for (const bool with_dvl : {true, false}) {
    auto stream = without(streamOf(scenario, 1), [&](const Reading& r) { return !with_dvl && isOf(r, Sensor::Dvl); });
    const auto before = [&](const Reading& r) { return placeOf(r) < placeOf(Reading(velocity)); };
    stream.insert(std::find_if_not(stream.begin(), stream.end(), before), velocity);
    const Start start = startOf(stream, optionsOf(scenario));
    EXPECT_EQ(start.parameters.start_velocity, 0.07);
    const Vector<3> of_lever = velocity.velocity_nav - start.state.velocity_nav;  // the antenna turns about the INS
    EXPECT_LT(of_lever.norm(), 0.5);
    EXPECT_GT(of_lever.norm(), 0);
  }
}

TEST(InsSession, AFixThatOnlyStartsItIsAsSureAsItsLeverArmLets) {
  const Scenario scenario = surveyOf(3);
  auto options = optionsOf(scenario);
  options.alignment.fixes_aid = false;
  auto stream = streamOf(scenario, 1);
  const auto heading = [&](double sigma) {
    for (auto& reading : stream)
      if (auto* inertial = std::get_if<InertialReading>(&reading)) inertial->attitude->heading_sigma = sigma;
    return startOf(stream, options).parameters.start_position;
  };
  const Parameters& p = scenario.parameters;
  EXPECT_LT((heading(1e-6) - p.gps_white).norm(), 0.01);
  const double across = p.gps_lever_body.head<2>().norm();
  EXPECT_NEAR(heading(0.5).x(), std::hypot(p.gps_white.x(), 0.5 * across), 0.1)
      << "30 degrees of heading turn the lever arm, which also tilts";
  EXPECT_NEAR(heading(0.5).z(), p.gps_white.z(), 0.01);
}

TEST(InsSession, WithoutBottomLockItStartsAtRestAndFindsItsVelocity) {
  const Scenario scenario = surveyOf(120);
  const auto stream = without(streamOf(scenario, 1), [](const Reading& r) { return isOf(r, Sensor::Dvl); });
  const Output output = settled(stream, optionsOf(scenario));
  EXPECT_EQ(output.solutions.front().stamp, kEpoch + 11 * kNanosecondsPerSecond);  // ten seconds after the first fix
  EXPECT_LT(positionError(scenario, output.solutions.back()), 6);
  const TruthSample truth = Trajectory(scenario.track, scenario.duration).at(120);
  EXPECT_LT((output.solutions.back().state.velocity_nav - truth.state.velocity_nav).norm(), 0.2);
}

TEST(InsSession, FixesBeforeTheFirstAttitudeWait) {
  const Scenario scenario = surveyOf(20);
  const auto stream = without(streamOf(scenario, 1), [](const Reading& r) {
    return isInertial(r) && stampOf(r) < kEpoch + 7 * kNanosecondsPerSecond / 2;
  });
  EXPECT_EQ(settled(stream, optionsOf(scenario)).solutions.front().stamp, kEpoch + 4 * kNanosecondsPerSecond);
}

TEST(InsSession, AnyOrderInsideTheLagGivesTheSameBits) {
  const Scenario scenario = surveyOf(60);
  const auto stream = streamOf(scenario, 3);
  const Output sorted = settled(stream, optionsOf(scenario, 2));
  for (const double delay : {0.3, 1.9}) expectSame(sorted, settled(shuffled(stream, delay), optionsOf(scenario, 2)));
  EXPECT_EQ(std::count_if(sorted.audits.begin(), sorted.audits.end(),
                          [](const Audit& a) { return a.verdict == Verdict::Accepted; }),
            59 * 7 + 3);
}

TEST(InsSession, WhatIsLaterThanTheLagIsRefusedAndCounted) {
  const Scenario scenario = surveyOf(40);
  auto stream = streamOf(scenario, 3);
  const auto fix = std::find_if(stream.begin(), stream.end(), [](const Reading& r) {
    return isOf(r, Sensor::Gps) && stampOf(r) > kEpoch + 20 * kNanosecondsPerSecond;
  });
  const Reading late = *fix;
  stream.insert(fix + 350, late);  // more than three seconds later
  stream.erase(
      std::find_if(stream.begin(), stream.end(), [&](const Reading& r) { return placeOf(r) == placeOf(late); }));
  const Output output = settled(stream, optionsOf(scenario, 2));
  const auto stale = std::find_if(output.audits.begin(), output.audits.end(),
                                  [](const Audit& a) { return std::string(a.reason) == "older than the lag"; });
  ASSERT_NE(stale, output.audits.end());
  EXPECT_EQ(stale->verdict, Verdict::Stale);
  EXPECT_EQ(stale->sensor, sensorName(Sensor::Gps));
}

TEST(InsSession, DuplicatesChangeNothing) {
  const Scenario scenario = surveyOf(30);
  const auto stream = streamOf(scenario, 3);
  std::vector<Reading> doubled;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    doubled.push_back(stream[i]);
    if (i % 10 == 0) doubled.push_back(stream[i]);
  }
  EstimatorRun session(optionsOf(scenario));
  session.process(doubled);
  session.finish();
  const Output once = settled(stream, optionsOf(scenario));
  const auto& solutions = session.output.solutions;
  ASSERT_EQ(solutions.size(), once.solutions.size());
  EXPECT_TRUE(solutions.back().state == once.solutions.back().state);
  const auto fused = std::count_if(session.output.audits.begin(), session.output.audits.end(), [](const Audit& audit) {
    return audit.verdict != Verdict::Stale && audit.verdict != Verdict::Invalid;
  });
  EXPECT_EQ(session.estimator->measurements(), static_cast<std::uint64_t>(fused));
  EXPECT_GT(session.timeline.refused(Timeline<InOrder>::Queue::Refusal::Duplicate), 0u);
}

TEST(InsSession, AGapOfTheInertialUnitIsBridgedCountedAndRecoveredFrom) {
  const Scenario scenario = surveyOf(90);
  const auto in_gap = [](const Reading& r) {
    const double time = secondsBetween(kEpoch, stampOf(r));
    return isInertial(r) && time > 40 && time < 42;
  };
  EstimatorRun session(optionsOf(scenario));
  session.process(without(streamOf(scenario, 1), in_gap));
  session.finish();
  EXPECT_EQ(session.estimator->inertial().verdicts[static_cast<std::size_t>(ImuVerdict::Bridged)], 1u);
  EXPECT_NEAR(session.estimator->inertial().longest_gap, 2, 1e-6);
  EXPECT_LT(positionError(scenario, session.output.solutions.back()), 8);
}

TEST(InsSession, AWrongRateIsCounted) {
  const Scenario scenario = surveyOf(20);
  int count = 0;
  const auto stream = without(streamOf(scenario, 1), [&](const Reading& r) { return isInertial(r) && ++count % 2; });
  EstimatorRun session(optionsOf(scenario));
  session.process(stream);
  session.finish();
  EXPECT_NEAR(session.estimator->inertial().mean_period, 0.02, 1e-9);
  EXPECT_GT(session.estimator->inertial().verdicts[static_cast<std::size_t>(ImuVerdict::OffRate)], 900u);
}

TEST(InsSession, OneWrongStampChangesLittleAndAClockThatIsSetStartsAnew) {
  const Scenario scenario = surveyOf(60);
  auto stream = streamOf(scenario, 1);
  const Output clean = settled(stream, optionsOf(scenario));
  auto one = stream;
  for (auto& reading : one)
    if (auto* inertial = std::get_if<InertialReading>(&reading);
        inertial && inertial->imu.stamp == kEpoch + 30 * kNanosecondsPerSecond)
      inertial->imu.stamp += 3600 * kNanosecondsPerSecond;
  const Output with_one = settled(one, optionsOf(scenario));
  EXPECT_EQ(with_one.solutions.size(), clean.solutions.size() - 1);
  EXPECT_LT(displacement(clean.solutions.back().state, with_one.solutions.back().state).norm(), 0.05);

  for (const Stamp jump : {3600 * kNanosecondsPerSecond, -3600 * kNanosecondsPerSecond}) {
    auto set = stream;
    for (auto& reading : set) {
      if (stampOf(reading) <= kEpoch + 30 * kNanosecondsPerSecond) continue;
      std::visit(
          [&](auto& r) {
            if constexpr (std::is_same_v<std::decay_t<decltype(r)>, InertialReading>)
              r.imu.stamp += jump;
            else
              r.stamp += jump;
          },
          reading);
    }
    const Output output = settled(set, optionsOf(scenario));
    const auto first = std::find_if(output.solutions.begin(), output.solutions.end(), [&](const NavigationSolution& s) {
      return std::abs(s.stamp - kEpoch) > jump / 2 + std::abs(jump) / 4 &&
             std::abs(s.stamp - kEpoch) > 1000 * kNanosecondsPerSecond;
    });
    ASSERT_NE(first, output.solutions.end());
    EXPECT_LT(secondsBetween(kEpoch + 30 * kNanosecondsPerSecond + jump, first->stamp), 5);
    NavigationSolution last = output.solutions.back();
    last.stamp -= jump;
    EXPECT_LT(positionError(scenario, last), 12);
  }
}

}  // namespace
}  // namespace sas_motion::ins
