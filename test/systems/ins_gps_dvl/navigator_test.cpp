// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/navigator.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "support.hpp"

namespace sas_motion::ins {
namespace {

template <class Filter>
using OptionsOf = typename Navigator<Filter>::Options;

/// Runs over a recording; `after` sees the navigator behind each reading of the IMU.
template <class Filter, class After>
void run(Navigator<Filter>& navigator, const Recording& recording, const After& after) {
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next) navigator.add(next->reading);
    navigator.add(reading);
    after(navigator);
  }
}

/// RMS of the horizontal position error after the first 120 s [m].
template <class Filter>
double positionError(const Filter& filter, const Scenario& scenario, std::uint64_t seed,
                     const OptionsOf<Filter>& options = {}) {
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, seed);
  Navigator<Filter> navigator(filter, scenario.parameters, recording.start, 0, options);
  double square = 0;
  int count = 0;
  run(navigator, recording, [&](const auto& n) {
    const double time = secondsBetween(0, n.stamp());
    if (time < 120) return;
    square += displacement(trajectory.at(time).state, n.fused()).template head<2>().squaredNorm();
    ++count;
  });
  return std::sqrt(square / count);
}

Scenario shortScenario(double duration) {
  Scenario scenario;
  scenario.duration = duration;
  scenario.parameters.gps_lever_body << 0.4, -1.2, 3.5;
  scenario.parameters.dvl_lever_body << 0.3, 2, -0.5;
  scenario.parameters.depth_lever_body << 0.1, 1, -0.2;
  return scenario;
}

/// A run to its end, without scoring.
template <class Filter>
Navigator<Filter> finished(const Filter& filter, const Scenario& scenario, const Recording& recording,
                           const OptionsOf<Filter>& options = {}) {
  Navigator<Filter> navigator(filter, scenario.parameters, recording.start, 0, options);
  run(navigator, recording, [](const auto&) {});
  return navigator;
}

Recording recordingOf(const Scenario& scenario, std::uint64_t seed) {
  return simulate(scenario, Trajectory(scenario.track, scenario.duration), seed);
}

TEST(InsNavigator, FusionIsBetterThanItsSensors) {
  // GIVEN fixes that are 2.9 m off, and an INS that drifts by 100 m in ten minutes
  double fused = 0, alone = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    fused += std::pow(positionError(KalmanFilter<kStates>(), shortScenario(600), seed), 2) / 4;
    alone += std::pow(positionError(Unaided(), shortScenario(600), seed), 2) / 4;
  }
  std::cout << "kf27 " << std::sqrt(fused) << " m, INS alone " << std::sqrt(alone) << " m\n";
  EXPECT_LT(std::sqrt(fused), 0.75 * 2.9);
  EXPECT_GT(std::sqrt(alone), 10 * std::sqrt(fused));
}

TEST(InsNavigator, RobustFormStandsOutliersOfGpsAndDvl) {
  Scenario scenario = shortScenario(400);
  const RobustKalmanFilter<kStates> robust({});
  double clean = 0, kalman = 0, outliers = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scenario bad = scenario;
    bad.sensor(Sensor::Gps).noise = bad.sensor(Sensor::Dvl).noise = testing::contaminated(0.1, 30);
    clean += positionError(robust, scenario, seed) / 3;
    outliers += positionError(robust, bad, seed) / 3;
    kalman += positionError(KalmanFilter<kStates>(), bad, seed) / 3;
  }
  EXPECT_LT(outliers, 1.3 * clean);
  EXPECT_LT(outliers, kalman);
}

TEST(InsNavigator, FeedbackAndOpenLoopAgreeWhileErrorsAreSmall) {
  const Scenario scenario = shortScenario(120);
  const Recording recording = recordingOf(scenario, 3);
  OptionsOf<KalmanFilter<kStates>> open;
  open.feedback = false;
  const auto closed = finished(KalmanFilter<kStates>(), scenario, recording);
  const auto closed_state = closed.fused();
  const double heading_sigma =
      std::sqrt(closed.belief().covariance(kAttitude + 2, kAttitude + 2)) * closed.model().unit()(kAttitude);
  const auto open_state = finished(KalmanFilter<kStates>(), scenario, recording, open).fused();
  EXPECT_LT(displacement(closed_state, open_state).norm(), 0.02);
  EXPECT_LT((closed_state.velocity_nav - open_state.velocity_nav).norm(), 1e-3);
  EXPECT_LT(attitudeError(closed_state.q_nav_body, open_state.q_nav_body).norm(), 0.02 * heading_sigma)
      << "second order in an error of a milliradian";
}

TEST(InsNavigator, ErrorsAreAsLargeAsItsCovarianceSays) {
  const Scenario scenario = shortScenario(200);
  const Trajectory trajectory(scenario.track, scenario.duration);
  constexpr int kRuns = 30;
  Vector<3> nees = Vector<3>::Zero();  // of velocity, position, attitude at the end
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto navigator = finished(KalmanFilter<kStates>(), scenario, simulate(scenario, trajectory, seed));
    const NavigationState truth = trajectory.at(scenario.duration).state, fused = navigator.fused();
    Vector<9> error;
    error << fused.velocity_nav - truth.velocity_nav, displacement(truth, fused),
        attitudeError(fused.q_nav_body, truth.q_nav_body) / navigator.model().unit()(kAttitude);
    for (int group = 0; group < 3; ++group) {
      const Vector<3> e = error.segment<3>(3 * group);
      const Matrix<3> P = navigator.belief().covariance.block<3, 3>(3 * group, 3 * group);
      nees(group) += e.dot(P.llt().solve(e)) / kRuns;
    }
  }
  const Band band = averageChiSquaredBand(3, kRuns, 0.99);
  for (int group = 0; group < 3; ++group) {
    EXPECT_GT(nees(group), band.lower) << "group " << group;
    EXPECT_LT(nees(group), band.upper) << "group " << group;
  }
}

TEST(InsNavigator, TheSolutionByGnssAloneHasTheStampsOfItsFixes) {
  // GIVEN fixes whose stamps lie between those of the IMU
  Scenario scenario = shortScenario(60);
  scenario.sensor(Sensor::Gps).rate = 0.93;
  const Recording recording = recordingOf(scenario, 5);
  Config config;
  config.parameters = scenario.parameters;
  const auto estimator = makeEstimator("gnss_alone", config);
  estimator->start(recording.start, 0);
  Output output;
  auto next = recording.aiding.begin();
  std::vector<Stamp> fixes, solutions;
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next) {
      if (next->reading.sensor == Sensor::Gps) fixes.push_back(next->reading.stamp);
      estimator->process(next->reading, output);
    }
    estimator->process(reading, output);
  }
  for (const auto& solution : output.solutions) solutions.push_back(solution.stamp);
  EXPECT_GT(fixes.size(), 50u);
  EXPECT_EQ(solutions, fixes);
}

TEST(InsNavigator, TakesReadingsBetweenThoseOfTheInertialUnit) {
  // GIVEN sensors at odd rates, so that their stamps lie between those of the IMU
  Scenario scenario = shortScenario(60);
  scenario.sensor(Sensor::Dvl).rate = scenario.parameters.dvl_rate = 4.7;
  scenario.sensor(Sensor::Gps).rate = 0.93;
  const Recording recording = recordingOf(scenario, 5);
  Navigator<KalmanFilter<kStates>> navigator({}, scenario.parameters, recording.start, 0, {});
  std::size_t audits = 0;
  double nis = 0;
  run(navigator, recording, [&](const auto& n) {
    for (const auto& audit : n.audits()) {
      EXPECT_EQ(audit.verdict, Verdict::Accepted);
      nis += audit.nis / audit.rows;
      ++audits;
    }
  });
  // THEN all are fused, and their innovations are as large as they should be
  EXPECT_EQ(audits, recording.aiding.size());
  EXPECT_NEAR(nis / static_cast<double>(audits), 1, 0.15);
}

TEST(InsNavigator, SmoothSolutionDoesNotJumpWhereAFixPullsTheFusedOne) {
  const Scenario scenario = shortScenario(120);
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, 4);
  Navigator<KalmanFilter<kStates>> navigator({}, scenario.parameters, recording.start, 0, {});
  double fused_jump = 0, steady_jump = 0;
  Vector<3> fused_error = Vector<3>::Zero(), steady_error = Vector<3>::Zero();
  run(navigator, recording, [&](const auto& n) {
    const double time = secondsBetween(0, n.stamp());
    const auto truth = trajectory.at(time).state;
    const Vector<3> fused = displacement(truth, n.fused()), steady = displacement(truth, n.steady());
    if (time > 60) {
      fused_jump = std::max(fused_jump, (fused - fused_error).head<2>().norm());
      steady_jump = std::max(steady_jump, (steady - steady_error).head<2>().norm());
    }
    fused_error = fused;
    steady_error = steady;
  });
  EXPECT_GT(fused_jump, 0.02);
  EXPECT_LT(steady_jump, 0.001) << "from one reading of the IMU to the next";
  EXPECT_LT((fused_error - steady_error).head<2>().norm(), 10) << "it stays near";
}

TEST(InsNavigator, ReportsLateReadings) {
  const Scenario scenario = shortScenario(1);
  const Recording recording = recordingOf(scenario, 1);
  Navigator<KalmanFilter<kStates>> navigator({}, scenario.parameters, recording.start, 0, {});
  run(navigator, recording, [](const auto&) {});
  const auto before = navigator.fused();
  Aiding late = recording.aiding.front().reading;
  navigator.add(late);
  navigator.add(
      ImuReading{recording.imu.back().stamp + 1, recording.imu.back().rate_body, recording.imu.back().force_body});
  ASSERT_EQ(navigator.audits().size(), 1u);
  EXPECT_EQ(navigator.audits().front().verdict, Verdict::Stale);
  EXPECT_LT(displacement(before, navigator.fused()).norm(), 1e-6);
}

TEST(InsNavigator, LivesThroughAGapOfTheInertialUnit) {
  // GIVEN an IMU that is silent for two seconds
  const Scenario scenario = shortScenario(120);
  const Trajectory trajectory(scenario.track, scenario.duration);
  Recording recording = simulate(scenario, trajectory, 2);
  recording.imu.erase(std::remove_if(recording.imu.begin(), recording.imu.end(),
                                     [](const ImuReading& r) {
                                       return r.stamp > stampFromSeconds(60) && r.stamp < stampFromSeconds(62);
                                     }),
                      recording.imu.end());
  Navigator<KalmanFilter<kStates>> navigator({}, scenario.parameters, recording.start, 0, {});
  double doubt_before = 0, doubt_after = 0;
  run(navigator, recording, [&](const auto& n) {
    const double doubt = n.belief().covariance(kVelocity, kVelocity);
    if (n.stamp() == stampFromSeconds(60)) doubt_before = doubt;
    if (n.stamp() == stampFromSeconds(62)) doubt_after = doubt;
  });
  // THEN the filter knows less of its velocity, and is no further off a minute later than it knows
  EXPECT_GT(doubt_after, doubt_before);
  const Vector<3> error = displacement(trajectory.at(120).state, navigator.fused());
  const Vector<3> sigma = navigator.belief().covariance.diagonal().segment<3>(kPosition).cwiseSqrt();
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(error(axis)), 4 * sigma(axis)) << "axis " << axis;
  EXPECT_LT(error.norm(), 20) << "the INS alone is 100 m off";
}

Scenario withMicronavigation(Scenario scenario) {
  scenario.sensor(Sensor::Dpc).rate = 8;
  scenario.parameters.dpc_lever_body << 0.5, 1, -0.3;
  scenario.dpc.white_sight = 0.3e-3;
  return scenario;
}

/// RMS after the first 60 s of the errors forward and along the sight of micronavigation [m/s].
Vector<2> velocityErrors(const Scenario& scenario, std::uint64_t seed) {
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, seed);
  Kf27 navigator({}, scenario.parameters, recording.start, 0, {});
  Vector<2> squares = Vector<2>::Zero();
  int count = 0;
  run(navigator, recording, [&](const auto& n) {
    const double time = secondsBetween(0, n.stamp());
    if (time < 60) return;
    const NavigationState truth = trajectory.at(time).state, fused = n.fused();
    const Vector<3> error_body =
        fused.q_nav_body.conjugate() * fused.velocity_nav - truth.q_nav_body.conjugate() * truth.velocity_nav;
    squares += Vector<2>(error_body.y(), error_body.dot(scenario.dpc.sightBody())).cwiseAbs2();
    ++count;
  });
  return (squares / count).cwiseSqrt();
}

TEST(InsNavigator, MicronavigationSharpensTheVelocityOnItsAxes) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Vector<2> without = velocityErrors(shortScenario(180), seed),
                    with = velocityErrors(withMicronavigation(shortScenario(180)), seed);
    EXPECT_LT(with.x(), 0.5 * without.x());
    EXPECT_LT(with.y(), 0.5 * without.y());
  }
}

TEST(InsSimulator, MicronavigationIsTheMeanVelocityOfTheArrayAndChangesNoOtherReading) {
  Scenario scenario = withMicronavigation(shortScenario(20));
  scenario.dpc.white_along = scenario.dpc.white_sight = 1e-9;
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, 7);
  Vector<2> squares = Vector<2>::Zero();
  std::vector<LabelledAiding> others;
  for (const auto& one : recording.aiding) {
    if (one.reading.sensor != Sensor::Dpc) {
      others.push_back(one);
      continue;
    }
    const TruthSample truth = trajectory.at(secondsBetween(0, one.reading.stamp));
    const auto z = ErrorModel(scenario.parameters, truth.state)
                       .dpc(truth.state, truth.rateBody(), one.reading.array, Errors::Zero());
    squares += z.innovation.cwiseAbs2() / 160;
  }
  EXPECT_EQ(recording.aiding.size() - others.size(), 160u);
  EXPECT_LT(std::sqrt(squares.x()), 0.2e-3) << "the mean over 0.125 s stands for the velocity in its middle";
  EXPECT_LT(std::sqrt(squares.y()), 0.2e-3);
  scenario.sensor(Sensor::Dpc).rate = 0;
  const auto plain = simulate(scenario, trajectory, 7).aiding;
  ASSERT_EQ(plain.size(), others.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(plain[i].reading.velocity_body, others[i].reading.velocity_body);
    EXPECT_EQ(plain[i].reading.fix.height, others[i].reading.fix.height);
  }
}

TEST(InsSimulator, SensorsHaveTheirOwnStreamsAndOutages) {
  Scenario scenario = shortScenario(20);
  const auto whole = recordingOf(scenario, 7).aiding;
  scenario.sensor(Sensor::Gps).outages = {{5, 10}};
  const auto under_water = recordingOf(scenario, 7).aiding;
  const auto count = [](const auto& all, Sensor sensor) {
    return std::count_if(all.begin(), all.end(),
                         [&](const LabelledAiding& one) { return one.reading.sensor == sensor; });
  };
  EXPECT_EQ(count(whole, Sensor::Gps), 20);
  EXPECT_EQ(count(under_water, Sensor::Gps), 14);
  EXPECT_EQ(count(under_water, Sensor::Dvl), count(whole, Sensor::Dvl));
  EXPECT_EQ(whole.back().reading.stamp, under_water.back().reading.stamp);
  EXPECT_EQ(whole.back().reading.fix.height, under_water.back().reading.fix.height)
      << "an outage changes no other reading";
}

}  // namespace
}  // namespace sas_motion::ins
