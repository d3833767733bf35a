// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"
#include "support.hpp"

namespace sas_motion::sins {
namespace {

Scenario scenarioOf(const std::string& name, double duration) {
  auto scenario =
      Scenario::fromFile(std::string(SAS_MOTION_SOURCE_DIR) + "/config/scenarios/sins_dvl/" + name + ".yaml");
  scenario.duration = duration;
  return scenario;
}

struct Outcome {
  std::vector<ins::NavigationSolution> solutions;
  std::vector<Audit> audits;
  Vector<3> position_error, attitude_error;  // at the end
};

Outcome run(const Scenario& scenario, const ins::Recording& recording, const std::string& name, int particles,
            int threads = 1, bool vectorised = true) {
  Config config;
  config.parameters = scenario.parameters;
  config.particles.particles = particles;
  config.particles.threads = threads;
  config.vectorised = vectorised;
  const auto estimator = makeEstimator(name, config);
  estimator->start(recording.start, 0);
  ins::Output output;
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
      estimator->process(next->reading, output);
    estimator->process(reading, output);
  }
  const NavigationState truth = ins::Trajectory(scenario.track, scenario.duration).at(scenario.duration).state,
                        &end = output.solutions.back().state;
  return {output.solutions, output.audits, displacement(truth, end), attitudeError(end.q_nav_body, truth.q_nav_body)};
}

ins::Recording recordingOf(const Scenario& scenario, std::uint64_t seed) {
  return simulate(scenario, ins::Trajectory(scenario.track, scenario.duration), seed);
}

TEST(SinsEstimator, ConvergesFromAHeadingThatIsThirtyDegreesOff) {
  Scenario scenario = scenarioOf("large_angle", 60);
  scenario.parameters.start_heading = 30 * kRadPerDeg;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto outcome = run(scenario, recordingOf(scenario, seed), "ss_srupf", 200);
    EXPECT_LT(std::abs(outcome.attitude_error.z()), 2 * kRadPerDeg) << "seed " << seed;
    EXPECT_LT(outcome.position_error.head<2>().norm(), 0.05 * 180) << "seed " << seed;
  }
}

TEST(SinsEstimator, GivesASolutionAtEveryReadingOfTheUnitAndAuditsEveryOther) {
  const Scenario scenario = scenarioOf("accuracy", 20);
  const auto recording = recordingOf(scenario, 4);
  for (const auto& named : namedFilters()) {
    const auto outcome = run(scenario, recording, named.name, 50);
    ASSERT_EQ(outcome.solutions.size(), recording.imu.size()) << named.name;
    ASSERT_EQ(outcome.audits.size(), recording.aiding.size()) << named.name;
    for (const auto& audit : outcome.audits) {
      EXPECT_EQ(audit.verdict, Verdict::Accepted) << named.name;
      EXPECT_GE(audit.effective_size, named.alone ? 0 : 1);
      EXPECT_LE(audit.effective_size, named.alone ? 0 : 50.0001);
    }
    EXPECT_EQ(outcome.solutions.back().covariance.has_value(), !named.steady) << named.name;
    EXPECT_LT(outcome.position_error.norm(), 5) << named.name;
  }
  EXPECT_EQ(makeEstimator("srukf", {}), nullptr);
}

TEST(SinsEstimator, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Scenario scenario = scenarioOf("large_angle", 10);
  const auto recording = recordingOf(scenario, 5);
  const auto one = run(scenario, recording, "ss_srupf", 100, 1), three = run(scenario, recording, "ss_srupf", 100, 3);
  EXPECT_EQ(one.position_error, three.position_error);
  EXPECT_EQ(one.attitude_error, three.attitude_error);
}

TEST(SinsEstimator, GivesTheSameByVectorInstructionsAndWithout) {
  const Scenario scenario = scenarioOf("large_angle", 20);
  const auto recording = recordingOf(scenario, 5);
  const auto blocks = run(scenario, recording, "ss_srupf", 100),
             each = run(scenario, recording, "ss_srupf", 100, 1, false);
  EXPECT_LT((blocks.position_error - each.position_error).norm(), 1e-6);
  EXPECT_LT((blocks.attitude_error - each.attitude_error).norm(), 1e-9);
  EXPECT_NEAR(blocks.audits.back().effective_size, each.audits.back().effective_size, 1e-3);
}

TEST(SinsEstimator, SixteenStatesTakeTheirWayToo) {
  const Scenario scenario = scenarioOf("accuracy", 10);
  Config config;
  config.parameters = scenario.parameters;
  config.accelerometer_bias = false;
  config.particles.particles = 20;
  const auto estimator = makeEstimator("ss_srupf", config);
  const auto recording = recordingOf(scenario, 6);
  ins::Output output;
  EXPECT_EQ(estimator->process(recording.imu.front(), output), ImuVerdict::OutOfOrder) << "not started";
  estimator->start(recording.start, 0);
  for (const auto& reading : recording.imu) estimator->process(reading, output);
  EXPECT_EQ(output.solutions.size(), recording.imu.size());
}

TEST(SinsEstimator, ReportsLateReadingsAndThoseOfGps) {
  const Scenario scenario = scenarioOf("accuracy", 3);
  const auto recording = recordingOf(scenario, 7);
  Config config;
  config.parameters = scenario.parameters;
  const auto estimator = makeEstimator("ss_srukf", config);
  estimator->start(recording.start, 0);
  ins::Output output;
  for (std::size_t k = 0; k <= 200; ++k) estimator->process(recording.imu[k], output);
  estimator->process(recording.aiding.front().reading, output);  // of the first second
  ins::Aiding fix;
  fix.stamp = stampFromSeconds(2.005);
  fix.sensor = ins::Sensor::Gps;
  estimator->process(fix, output);
  output.clear();
  estimator->process(recording.imu[201], output);
  ASSERT_EQ(output.audits.size(), 2u);
  EXPECT_EQ(output.audits[0].verdict, Verdict::Stale);
  EXPECT_EQ(output.audits[1].verdict, Verdict::Invalid);
}

/// Position error over what the covariance says of it, at the end.
double horizontalNees(const Outcome& outcome) {
  const Matrix<2> P = outcome.solutions.back().covariance->block<2, 2>(3, 3);
  const Vector<2> error = outcome.position_error.head<2>();
  return error.dot(P.llt().solve(error));
}

TEST(SinsEstimator, BridgesAGapOfTheUnitAndSaysHowUnsureItIsThen) {
  // GIVEN a gap of two seconds in which the body yaws and pitches, WHEN the DVL goes on, THEN nothing runs away, and
  // the covariance has grown with the gap
  const Scenario scenario = scenarioOf("accuracy", 90);
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto recording = recordingOf(scenario, seed);
    const auto whole = run(scenario, recording, "ss_srupf", 100);
    const auto in_gap = [](const ImuReading& reading) {
      return reading.stamp > stampFromSeconds(60) && reading.stamp < stampFromSeconds(62);
    };
    recording.imu.erase(std::remove_if(recording.imu.begin(), recording.imu.end(), in_gap), recording.imu.end());
    const auto gappy = run(scenario, recording, "ss_srupf", 100);
    ASSERT_EQ(gappy.solutions.size(), recording.imu.size());
    EXPECT_GT(gappy.solutions.back().covariance->diagonal().segment<2>(3).sum(),
              2 * whole.solutions.back().covariance->diagonal().segment<2>(3).sum());
    EXPECT_LT(horizontalNees(gappy), chiSquaredQuantile(0.999, 2)) << "seed " << seed;
    EXPECT_LT(std::abs(gappy.attitude_error.z()), 3 * std::sqrt((*gappy.solutions.back().covariance)(8, 8)))
        << "seed " << seed;
  }
}

TEST(SinsEstimator, LivesThroughMinutesWithoutTheDvl) {
  // GIVEN a start 5 degrees off and no bottom lock from 60 s to 240 s, WHEN it comes back, THEN the error is what the
  // covariance said, and the velocity is back
  const Scenario scenario = scenarioOf("large_angle", 260);
  for (const std::uint64_t seed : {1, 2}) {
    auto recording = recordingOf(scenario, seed);
    const auto lost = [](const ins::LabelledAiding& aiding) {
      return aiding.reading.sensor == ins::Sensor::Dvl && aiding.reading.stamp > stampFromSeconds(60) &&
             aiding.reading.stamp < stampFromSeconds(240);
    };
    recording.aiding.erase(std::remove_if(recording.aiding.begin(), recording.aiding.end(), lost),
                           recording.aiding.end());
    const auto outcome = run(scenario, recording, "ss_srupf", 200);
    EXPECT_LT(horizontalNees(outcome), chiSquaredQuantile(0.999, 2)) << "seed " << seed;
    const NavigationState truth = ins::Trajectory(scenario.track, scenario.duration).at(scenario.duration).state;
    EXPECT_LT((outcome.solutions.back().state.velocity_nav - truth.velocity_nav).norm(), 0.1) << "seed " << seed;
    for (const auto& audit : outcome.audits) EXPECT_NE(audit.verdict, Verdict::Invalid);
  }
}

TEST(SinsEstimator, AReadingThatIsNoNumberIsRefusedAndHarmsNothing) {
  const Scenario scenario = scenarioOf("accuracy", 20);
  const auto recording = recordingOf(scenario, 8);
  for (const std::string name : {"pf", "upf", "ss_srupf", "ss_srukf"}) {
    auto spoilt = recording;
    for (auto& aiding : spoilt.aiding)
      if (aiding.reading.sensor == ins::Sensor::Dvl && aiding.reading.stamp == stampFromSeconds(5))
        aiding.reading.velocity_body.x() = std::nan("");
    const auto outcome = run(scenario, spoilt, name, 50);
    std::size_t invalid = 0;
    for (const auto& audit : outcome.audits) invalid += audit.verdict == Verdict::Invalid;
    EXPECT_EQ(invalid, 2u) << name << ": the DVL's, and the depth of the same moment";
    EXPECT_LT(outcome.position_error.norm(), 5) << name;
    EXPECT_TRUE(outcome.solutions.back().covariance->allFinite()) << name;
  }
}

TEST(SinsEstimator, ACopyGoesItsOwnWayAndLeavesTheOther) {
  const Scenario scenario = scenarioOf("accuracy", 6);
  const auto recording = recordingOf(scenario, 9);
  Config config;
  config.parameters = scenario.parameters;
  config.particles.particles = 40;
  for (const std::string name : {"pf", "upf", "ss_srupf", "steady_ss_srupf"}) {
    const auto estimator = makeEstimator(name, config);
    estimator->start(recording.start, 0);
    ins::Output output, copied;
    const auto feed = [&](ins::Estimator& one, double from, double to, ins::Output& into) {
      for (const auto& aiding : recording.aiding)
        if (aiding.reading.stamp > stampFromSeconds(from) && aiding.reading.stamp <= stampFromSeconds(to))
          one.process(aiding.reading, into);
      for (const auto& reading : recording.imu)
        if (reading.stamp > stampFromSeconds(from) && reading.stamp <= stampFromSeconds(to)) one.process(reading, into);
    };
    feed(*estimator, -1, 3, output);
    const auto copy = estimator->clone();
    feed(*copy, 3, 6, copied);
    output.clear();
    feed(*estimator, 3, 6, output);
    ASSERT_EQ(output.solutions.size(), copied.solutions.size());
    EXPECT_EQ(output.solutions.back().state.velocity_nav, copied.solutions.back().state.velocity_nav) << name;
    EXPECT_EQ(output.solutions.back().state.latitude, copied.solutions.back().state.latitude) << name;
  }
}

TEST(SinsEstimator, LeverArmsOfReadingsAreTakenOut) {
  // GIVEN a DVL 3 m ahead of the INS and a gauge below it, WHEN readings say so, THEN the solution is as good as
  // without, and else it is worse
  Scenario scenario = scenarioOf("aligned", 60);
  scenario.parameters.dvl_lever_body = {0.5, 3, -0.5};
  scenario.parameters.depth_lever_body = {0, 2, -1};
  const auto recording = recordingOf(scenario, 10);
  Scenario unaware = scenario;
  unaware.parameters.dvl_lever_body = unaware.parameters.depth_lever_body = Vector<3>::Zero();
  auto told = recording;
  for (auto& aiding : told.aiding) {
    aiding.reading.lever_body = aiding.reading.sensor == ins::Sensor::Dvl ? scenario.parameters.dvl_lever_body
                                                                          : scenario.parameters.depth_lever_body;
  }
  const auto known = run(scenario, recording, "ss_srukf", 1), by_reading = run(unaware, told, "ss_srukf", 1),
             blind = run(unaware, recording, "ss_srukf", 1);
  EXPECT_LT((known.position_error - by_reading.position_error).norm(), 1e-6);
  EXPECT_GT(std::abs(blind.position_error.z()), 3 * std::abs(known.position_error.z()) + 0.5);
}

}  // namespace
}  // namespace sas_motion::sins
