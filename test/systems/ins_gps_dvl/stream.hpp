// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "sas_motion/session/timeline.hpp"
#include "sas_motion/systems/ins_gps_dvl/aligned_estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion::ins::testing {

constexpr Stamp kEpoch = 1'600'000'000 * kNanosecondsPerSecond;

inline Scenario surveyOf(double duration) {
  Scenario scenario = Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/ins/survey.yaml");
  scenario.duration = duration;
  return scenario;
}

template <class Map>
std::vector<Reading> valuesOf(const Map& map) {
  std::vector<Reading> values;
  for (const auto& entry : map) values.push_back(entry.second);
  return values;
}

/// A simulated run as readings in the order of their stamps, with the attitude that `simulate` writes: the true one
/// with the errors of the start.
inline std::vector<Reading> streamOf(const Scenario& scenario, std::uint64_t seed) {
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, seed);
  const Eigen::Quaterniond error = recording.start.q_nav_body * trajectory.at(0).state.q_nav_body.conjugate();
  const Parameters& p = scenario.parameters;
  std::multimap<std::tuple<Stamp, std::size_t>, Reading> stream;
  const auto add = [&](const Reading& reading) { stream.emplace(placeOf(reading), reading); };
  for (std::size_t k = 1; k < recording.imu.size(); ++k) {
    InertialReading reading{recording.imu[k], {}};
    reading.attitude = MeasuredAttitude{error * trajectory.at(secondsBetween(0, reading.imu.stamp)).state.q_nav_body,
                                        p.start_tilt, p.start_heading};
    reading.imu.stamp += kEpoch;
    add(reading);
  }
  for (const auto& labelled : recording.aiding) {
    Aiding reading = labelled.reading;
    reading.stamp += kEpoch;
    add(reading);
  }
  return valuesOf(stream);
}

inline SessionOptions optionsOf(const Scenario& scenario, double lag = 2) {
  SessionOptions options;
  options.config.parameters = scenario.parameters;
  options.config.imu.period = 1 / scenario.imu_rate;
  options.lag = lag;
  return options;
}

inline bool isOf(const Reading& reading, Sensor sensor) {
  const auto* aiding = std::get_if<Aiding>(&reading);
  return aiding && aiding->sensor == sensor;
}
inline bool isInertial(const Reading& reading) { return std::holds_alternative<InertialReading>(reading); }

/// What is left of a stream without some of its readings.
template <class Unwanted>
std::vector<Reading> without(std::vector<Reading> stream, const Unwanted& unwanted) {
  stream.erase(std::remove_if(stream.begin(), stream.end(), unwanted), stream.end());
  return stream;
}

/// One estimator over readings in any order, with its settled output.
struct EstimatorRun {
  explicit EstimatorRun(const SessionOptions& options, const std::string& name = "kf27", bool keeps_present = false)
      : estimator(new AlignedEstimator(options, name, makeEstimator)),
        timeline(std::unique_ptr<InOrder>(estimator), options.config, options.max_gap, keeps_present) {}

  void process(const Reading& reading) { timeline.process(reading, output); }
  void process(const std::vector<Reading>& stream) {
    for (const auto& reading : stream) process(reading);
  }
  void finish() { timeline.finish(output); }

  AlignedEstimator* estimator;
  Timeline<InOrder> timeline;
  Output output;
};

/// The settled output of one estimator over a stream.
inline Output settled(const std::vector<Reading>& stream, const SessionOptions& options,
                      const std::string& name = "kf27") {
  EstimatorRun run(options, name);
  run.process(stream);
  run.finish();
  return run.output;
}

/// A stream whose readings of GPS and DVL come late by `delay` at most, drawn from a fixed sequence [s].
inline std::vector<Reading> shuffled(const std::vector<Reading>& stream, double delay) {
  std::multimap<Stamp, Reading> arrivals;
  std::uint32_t state = 12345;
  for (const auto& reading : stream) {
    state = 1664525 * state + 1013904223;
    const double longest = isInertial(reading) ? 0.1 * delay : delay;
    arrivals.emplace(stampOf(reading) + stampFromSeconds(longest * state / 4294967296.0), reading);
  }
  return valuesOf(arrivals);
}

}  // namespace sas_motion::ins::testing
