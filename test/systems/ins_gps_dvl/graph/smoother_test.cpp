// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/smoother.hpp"

#include <gtsam/nonlinear/Marginals.h>

#include <cmath>
#include <limits>

#include "campaign/suites.hpp"
#include "support.hpp"
#include "systems/ins_gps_dvl/graph/runs.hpp"

namespace sas_motion::ins {
namespace {

using testing::outputOf;
using testing::positionError;
using testing::recordingOf;
using testing::surveyOf;
using testing::tiltError;

void addOutliers(Scenario& scenario) {
  scenario.sensor(Sensor::Gps).noise =
      scenario.sensor(Sensor::Dvl).noise = {{sas_motion::testing::contaminated(0.1, 10)}};
}

InsSmoother::Options linearLoss() {
  InsSmoother::Options options;
  options.loss = Loss(LossKind::L2);
  return options;
}

TEST(InsSmoother, NamesTheGraphsEstimatorsAndThoseOfTheCore) {
  for (const char* name : {"batch", "fixed_lag", "kf27", "steady_robust_kf27"})
    EXPECT_TRUE(makeAnyEstimator(name, {})) << name;
  EXPECT_FALSE(makeAnyEstimator("no_such_estimator", {}));
}

TEST(InsSmoother, AtTheEndBatchIsTheKalmanFilter) {
  // GIVEN Gaussian noise and no loss, THEN what is behind the last stamp is nothing, and both are the same estimate
  const Scenario scenario = surveyOf(100);
  const Recording recording = recordingOf(scenario, 3);
  InsSmoother batch(configOf(scenario), linearLoss());
  const Output smoothed = outputOf(batch, recording), filtered = outputOf("kf27", scenario, recording);
  const NavigationSolution &a = smoothed.solutions.back(), &b = filtered.solutions.back();
  ASSERT_EQ(a.stamp, b.stamp);
  const Vector<9> sigma = b.covariance->diagonal().cwiseSqrt();
  Vector<9> difference;
  difference << a.state.velocity_nav - b.state.velocity_nav, displacement(b.state, a.state),
      attitudeError(a.state.q_nav_body, b.state.q_nav_body);
  EXPECT_LT(difference.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.05)
      << difference.transpose() << " of " << sigma.transpose();
  EXPECT_LT(((*a.covariance).diagonal().cwiseSqrt().cwiseQuotient(sigma).array() - 1).abs().maxCoeff(), 0.02);
}

TEST(InsSmoother, AWindowAsLongAsTheDataIsBatch) {
  Scenario scenario = surveyOf(60);
  addOutliers(scenario);
  const Recording recording = recordingOf(scenario, 4);
  InsSmoother::Options options;
  InsSmoother batch(configOf(scenario), options);
  options.window = FixedLag();
  options.window->lag = 100;
  InsSmoother lag(configOf(scenario), options);
  const Output one = outputOf(batch, recording), other = outputOf(lag, recording);
  ASSERT_EQ(one.solutions.size(), other.solutions.size());
  for (std::size_t k = 0; k < one.solutions.size(); k += 50) {
    ASSERT_EQ(one.solutions[k].stamp, other.solutions[k].stamp);
    EXPECT_LT(displacement(one.solutions[k].state, other.solutions[k].state).norm(), 1e-3);
    EXPECT_LT(attitudeError(one.solutions[k].state.q_nav_body, other.solutions[k].state.q_nav_body).norm(), 1e-6);
  }
}

TEST(InsSmoother, FixedLagLiesBetweenFilterAndBatchAndPutsOutAsItGoes) {
  double filter = 0, lag = 0, batch = 0;
  for (const std::uint64_t seed : {1, 2}) {
    const Scenario scenario = surveyOf(100);
    const Recording recording = recordingOf(scenario, seed);
    InsSmoother::Options options;
    options.window = FixedLag();
    options.window->lag = 20;
    InsSmoother smoother(configOf(scenario), options);
    Output live;
    smoother.start(recording.start, 0);
    testing::feed(smoother, recording, live);
    ASSERT_FALSE(live.solutions.empty());
    EXPECT_NEAR(secondsBetween(live.solutions.back().stamp, recording.imu.back().stamp), 22.5, 2.6)
        << "lag and half of what passes between two solutions";
    EXPECT_LE(smoother.window()->size(), 5 * 26U) << "what is settled is forgotten";
    smoother.finish(live);
    EXPECT_EQ(live.solutions.size() + 1, recording.imu.size());
    filter += tiltError(outputOf("robust_kf27", scenario, recording), scenario, 30);
    lag += tiltError(live, scenario, 30);
    batch += tiltError(outputOf("batch", scenario, recording), scenario, 30);
  }
  std::cout << "tilt: robust_kf27 " << filter / 2 << ", fixed_lag " << lag / 2 << ", batch " << batch / 2 << " rad\n";
  EXPECT_LT(lag, filter);
  EXPECT_LT(batch, lag);
}

TEST(InsSmoother, LearnsLeverArmsFromReadings) {
  // GIVEN a run whose configuration knows the lever arms, and one whose readings bring them
  const Scenario scenario = surveyOf(40);
  Recording recording = recordingOf(scenario, 3);
  const Output told = outputOf("batch", scenario, recording);
  Scenario untold = scenario;
  Parameters levers = scenario.parameters;
  for (const auto sensor : {Sensor::Gps, Sensor::Dvl, Sensor::Depth}) leverOf(untold.parameters, sensor).setZero();
  for (auto& labelled : recording.aiding) labelled.reading.lever_body = leverOf(levers, labelled.reading.sensor);
  const Output learned = outputOf("batch", untold, recording);
  // THEN they agree, height included
  ASSERT_EQ(told.solutions.size(), learned.solutions.size());
  for (std::size_t k = 0; k < told.solutions.size(); k += 100)
    EXPECT_LT(displacement(told.solutions[k].state, learned.solutions[k].state).norm(), 1e-6) << k;
}

TEST(InsSmoother, BatchBeatsTheFilterAlsoWithOutliers) {
  for (const bool bad : {false, true}) {
    double filter = 0, batch = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
      Scenario scenario = surveyOf(240);
      if (bad) addOutliers(scenario);
      const Recording recording = recordingOf(scenario, seed);
      filter += std::pow(positionError(outputOf("robust_kf27", scenario, recording), scenario, 60), 2);
      batch += std::pow(positionError(outputOf("batch", scenario, recording), scenario, 60), 2);
    }
    EXPECT_LT(std::sqrt(batch / filter), 0.9) << (bad ? "outliers" : "clean");
  }
}

TEST(InsSmoother, ErrorsAreAsLargeAsItsCovarianceSays) {
  const Scenario scenario = surveyOf(60);
  const Trajectory trajectory(scenario.track, scenario.duration);
  constexpr int kRuns = 30;
  Vector<3> nees = Vector<3>::Zero();  // of velocity, position, attitude in the middle
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    InsSmoother batch(configOf(scenario), linearLoss());
    const Output output = outputOf(batch, simulate(scenario, trajectory, seed));
    const NavigationSolution& solution = output.solutions[3000];
    const NavigationState truth = trajectory.at(secondsBetween(0, solution.stamp)).state;
    Vector<9> error;
    error << solution.state.velocity_nav - truth.velocity_nav, displacement(truth, solution.state),
        attitudeError(solution.state.q_nav_body, truth.q_nav_body);
    for (int group = 0; group < 3; ++group) {
      const Vector<3> e = error.segment<3>(3 * group);
      nees(group) +=
          e.dot(Matrix<3>(solution.covariance->block<3, 3>(3 * group, 3 * group)).llt().solve(e)) / (3 * kRuns);
    }
  }
  EXPECT_GT(nees.minCoeff(), 0.65) << nees.transpose() << ", 99.9 % of chi-square with 90 degrees of freedom";
  EXPECT_LT(nees.maxCoeff(), 1.45) << nees.transpose();
}

TEST(InsSmoother, NowhereJumps) {
  const Scenario scenario = surveyOf(60);
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Output output = outputOf("batch", scenario, simulate(scenario, trajectory, 5));
  for (std::size_t k = 1; k < output.solutions.size(); ++k) {
    const auto &a = output.solutions[k - 1], &b = output.solutions[k];
    const Vector<3> moved = displacement(a.state, b.state),
                    meant = displacement(trajectory.at(secondsBetween(0, a.stamp)).state,
                                         trajectory.at(secondsBetween(0, b.stamp)).state);
    const Vector<3> drift = 0.01 * 0.5 *
                            (a.state.velocity_nav - trajectory.at(secondsBetween(0, a.stamp)).state.velocity_nav +
                             b.state.velocity_nav - trajectory.at(secondsBetween(0, b.stamp)).state.velocity_nav);
    EXPECT_LT((moved - meant - drift).norm(), 1e-5) << "at " << secondsBetween(0, b.stamp) << " s";
  }
}

TEST(InsSmoother, EstimatesAScaleAndMisalignmentThatTheFilterDoesNotKnow) {
  // GIVEN a DVL that is scaled and turned by standard deviations of 2 % and 1 degree
  double filter = 0, batch = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scenario scenario = surveyOf(240);
    scenario.parameters.dvl_scale = 0.02;
    scenario.parameters.dvl_misalignment = 1 * kRadPerDeg;
    const Recording recording = recordingOf(scenario, seed);
    InsSmoother smoother(configOf(scenario), {});
    batch += std::pow(positionError(outputOf(smoother, recording), scenario, 60), 2);
    filter += std::pow(positionError(outputOf("robust_kf27", scenario, recording), scenario, 60), 2);
    EXPECT_NE(smoother.window()->dvlScale(), 0);
    EXPECT_NE(smoother.window()->dvlMisalignment().norm(), 0);
  }
  EXPECT_LT(std::sqrt(batch / filter), 0.6);
}

TEST(InsSmoother, FindsADvlThatIsNotWhereItIsToldToBe) {
  // GIVEN a survey with turns, whose DVL sits half a metre off, drawn by what the graph is told
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scenario scenario = surveyOf(300);
    scenario.parameters.dvl_lever_body += Vector<3>(0.5, -0.5, 0.3);
    const Recording recording = recordingOf(scenario, seed);
    Scenario told = scenario;
    told.parameters.dvl_lever_body -= Vector<3>(0.5, -0.5, 0.3);
    told.parameters.dvl_lever_sigma = 0.5;
    InsSmoother::Options options;
    options.window = FixedLag();
    options.window->lag = 1000;  // so that the graph stays to be looked at
    options.window->solve_interval = 100;
    InsSmoother smoother(configOf(told), options);
    Output output;
    smoother.start(recording.start, 0);
    testing::feed(smoother, recording, output);
    const Vector<3> off = smoother.window()->dvlLever() - Vector<3>(0.5, -0.5, 0.3);
    const gtsam::Marginals marginals(smoother.window()->graph(), smoother.window()->values());
    const Matrix<3> P = marginals.marginalCovariance(kDvlLeverKey);
    EXPECT_LT(off.dot(P.llt().solve(off)), 16.3)
        << "99.9 % of chi-square with 3 degrees of freedom, off by " << off.transpose();
    EXPECT_LT(P.diagonal().cwiseSqrt().maxCoeff(), 0.2) << "much less than what was believed";
    EXPECT_LT(off.norm(), 0.3);
  }
}

TEST(InsSmoother, StandsWhatSensorsReallySend) {
  const Scenario scenario = surveyOf(40);
  Recording recording = recordingOf(scenario, 6);
  // GIVEN a gap of the IMU, nonsense, readings that are late, and some between its stamps a microsecond apart
  recording.imu.erase(recording.imu.begin() + 2000, recording.imu.begin() + 2300);
  recording.imu[1000].force_body.x() = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < recording.aiding.size(); ++k)
    recording.aiding[k].reading.stamp -= static_cast<Stamp>(1000 * (k % 3));
  recording.aiding[20].reading.velocity_body.y() = std::numeric_limits<double>::quiet_NaN();
  recording.aiding[50].reading.stamp = recording.aiding[10].reading.stamp;
  for (const char* name : {"batch", "fixed_lag"}) {
    const auto estimator = makeAnyEstimator(name, configOf(scenario));
    const Output output = outputOf(*estimator, recording);
    EXPECT_EQ(estimator->failure(), "") << name;
    EXPECT_EQ(output.audits.size(), recording.aiding.size()) << name;
    const auto count = [&](Verdict verdict) {
      return std::count_if(output.audits.begin(), output.audits.end(),
                           [&](const Audit& a) { return a.verdict == verdict; });
    };
    EXPECT_EQ(count(Verdict::Stale), 1) << name;
    EXPECT_EQ(output.solutions.size(), recording.imu.size() - 2)
        << name << ": one for each reading that is believed, but the first";
    for (const auto& solution : output.solutions)
      EXPECT_TRUE(solution.state.velocity_nav.allFinite() && solution.covariance->allFinite()) << name;
    EXPECT_LT(positionError(output, scenario, 10), 10) << name;
  }
}

TEST(InsSmoother, SaysWhyThereIsNoAnswer) {
  const Scenario scenario = surveyOf(10);
  Recording recording = recordingOf(scenario, 7);
  recording.start.velocity_nav.x() = std::numeric_limits<double>::quiet_NaN();
  for (const char* name : {"batch", "fixed_lag"}) {
    const auto estimator = makeAnyEstimator(name, configOf(scenario));
    EXPECT_TRUE(outputOf(*estimator, recording).solutions.empty()) << name;
    EXPECT_NE(estimator->failure(), "") << name;
  }
}

TEST(InsSmoother, CampaignsScoreItBesideTheFilters) {
  const auto suite = sas_motion::testing::suiteOf(
      "{runs: 1, campaigns: [{name: ins, system: ins_gps_dvl, scenario: " SAS_MOTION_SOURCE_DIR
      "/config/scenarios/ins/survey.yaml, duration: 60, skip: 20, estimators: [robust_kf27, batch, fixed_lag], laws: "
      "[{name: bad, noise: {law: contaminated, "
      "epsilon: 0.1, K: 30}}]}]}",
      sas_motion::testing::readers(makeAnyEstimator));
  const auto reports = suite.campaigns[0]->run(0, 1);
  ASSERT_EQ(reports.size(), 3U);
  for (const auto& report : reports) {
    EXPECT_EQ(report.samples, reports.front().samples) << report.estimator;
    EXPECT_FALSE(report.nees.empty()) << report.estimator;
    EXPECT_GT(*report.recall, 0.7) << report.estimator;
    EXPECT_GT(*report.precision, 0.8) << report.estimator;
  }
  EXPECT_LT(*reports[1].aperture_across, 0.1 * *reports[0].aperture_across) << "no fix bends the smoother's way";
}

TEST(InsSmoother, GoesOnAfterAPause) {
  const Scenario scenario = surveyOf(60);
  const Recording recording = recordingOf(scenario, 8);
  for (const char* name : {"batch", "fixed_lag"}) {
    const auto estimator = makeAnyEstimator(name, configOf(scenario));
    Output output;
    estimator->start(recording.start, 0);
    auto next = recording.aiding.begin();
    for (const auto& reading : recording.imu) {
      for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
        estimator->process(next->reading, output);
      estimator->process(reading, output);
      if (reading.stamp == stampFromSeconds(30)) estimator->finish(output);
    }
    estimator->finish(output);
    EXPECT_EQ(output.solutions.size() + 1, recording.imu.size()) << name;
    EXPECT_EQ(output.audits.size(), recording.aiding.size()) << name;
    EXPECT_LT(positionError(output, scenario, 20),
              1.2 * positionError(outputOf("robust_kf27", scenario, recording), scenario, 20))
        << name;
  }
}

}  // namespace
}  // namespace sas_motion::ins
