// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/ins_gps_dvl/graph/smoother.hpp"

namespace sas_motion::ins::testing {

/// The survey, shortened.
inline Scenario surveyOf(double duration) {
  Scenario scenario = Scenario::fromFile(std::string(SAS_MOTION_SOURCE_DIR) + "/config/scenarios/ins/survey.yaml");
  scenario.duration = duration;
  return scenario;
}

inline Recording recordingOf(const Scenario& scenario, std::uint64_t seed) {
  return simulate(scenario, Trajectory(scenario.track, scenario.duration), seed);
}

/// Feeds the readings from one on that come no later than the end of the IMU's, without the finish.
inline void feed(Estimator& estimator, const Recording& recording, Output& output) {
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
      estimator.process(next->reading, output);
    estimator.process(reading, output);
  }
}

/// All that an estimator makes of a run.
inline Output outputOf(Estimator& estimator, const Recording& recording) {
  Output output;
  estimator.start(recording.start, 0);
  feed(estimator, recording, output);
  estimator.finish(output);
  return output;
}

inline Output outputOf(const std::string& name, const Scenario& scenario, const Recording& recording) {
  return outputOf(*makeAnyEstimator(name, configOf(scenario)), recording);
}

/// RMS from `skip` on of `error(solution, truth)`.
template <class Error>
double rmsError(const Output& output, const Scenario& scenario, double skip, const Error& error) {
  const Trajectory trajectory(scenario.track, scenario.duration);
  double square = 0, count = 0;
  for (std::size_t k = 0; k < output.solutions.size(); k += 20) {
    const double time = secondsBetween(0, output.solutions[k].stamp);
    if (time < skip) continue;
    square += Vector<2>(error(output.solutions[k].state, trajectory.at(time).state)).squaredNorm();
    ++count;
  }
  return std::sqrt(square / count);
}

/// Of the horizontal position [m].
inline double positionError(const Output& output, const Scenario& scenario, double skip) {
  return rmsError(output, scenario, skip, [](const NavigationState& state, const NavigationState& truth) {
    return displacement(truth, state).head<2>().eval();
  });
}

/// Of the tilt, whose errors are short, so that a few runs have many of them [rad].
inline double tiltError(const Output& output, const Scenario& scenario, double skip) {
  return rmsError(output, scenario, skip, [](const NavigationState& state, const NavigationState& truth) {
    return attitudeError(state.q_nav_body, truth.q_nav_body).head<2>().eval();
  });
}

}  // namespace sas_motion::ins::testing
