// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/run_scorer.hpp"

#include <limits>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kScoreEvery = 0.1, kSame = 1e-6;  // [s]

/// Of all nine together; each is scaled by its own deviation first: m/s, m and rad are far from alike.
double fullSquare(const Vector<9>& error, const Matrix<9>& P) {
  const Vector<9> scale = P.diagonal().cwiseSqrt(), scaled = error.cwiseQuotient(scale);
  const Matrix<9> correlation = scale.cwiseInverse().asDiagonal() * P * scale.cwiseInverse().asDiagonal();
  return normalisedSquare<9>(scaled, correlation);
}

ScorerOptions optionsOf(const Scenario& scenario, Sensor traced, const ApertureOptions& aperture) {
  ScorerOptions options;
  options.aperture = aperture;
  options.speed = scenario.track.speed;
  options.traced = sensorName(traced);
  options.square_by_degree = true;
  return options;
}

}  // namespace

double replay(Estimator& estimator, const Recording& recording, const std::function<void(const Output&)>& take) {
  Output output;
  double seconds = 0;
  const auto timed = [&](const auto& work) {
    const double begin = cpuSeconds();
    work();
    seconds += cpuSeconds() - begin;
    take(output);
    output.clear();
  };
  estimator.start(recording.start, 0);
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu)
    timed([&] {
      for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
        estimator.process(next->reading, output);
      estimator.process(reading, output);
    });
  timed([&] { estimator.finish(output); });
  return seconds;
}

RunScorer::RunScorer(const std::string& estimator, const Scenario& scenario, const Trajectory& trajectory, double skip,
                     Sensor traced, const ApertureOptions& aperture, Watch watch)
    : scenario_(scenario),
      trajectory_(trajectory),
      skip_(skip),
      traced_(traced),
      watch_(std::move(watch)),
      scorer_(estimator, optionsOf(scenario, traced, aperture)) {
  scorer_.trace().nees_degrees = 9;
  scorer_.trace().nis_degrees = rowsOf(traced);
}

bool RunScorer::counts(double time) {
  const double ticks = time / kScoreEvery;
  return std::abs(ticks - std::round(ticks)) < kSame;
}

void RunScorer::add(const NavigationSolution& solution) {
  const double time = secondsBetween(0, solution.stamp);
  if (!counts(time)) return;
  const TruthSample truth = trajectory_.at(time);
  if (watch_) watch_(truth, solution);
  Vector<9> error;
  error << solution.state.velocity_nav - truth.state.velocity_nav, displacement(truth.state, solution.state),
      attitudeError(solution.state.q_nav_body, truth.state.q_nav_body);
  const Vector<3> velocity = error.segment<3>(kVelocity), position = error.segment<3>(kPosition),
                  phi = error.segment<3>(kAttitude);
  trace(solution, time, error);
  if (time >= skip_) {
    scorer_.addSample(position.allFinite() && velocity.allFinite());
    scorer_.addError("position", position.head<2>().norm());
    scorer_.addError("height", std::abs(position.z()));
    if (solution.has_velocity) scorer_.addError("velocity", velocity.norm());
    if (solution.has_attitude) {
      scorer_.addError("tilt", phi.head<2>().norm());
      scorer_.addError("heading", std::abs(phi.z()));
    }
    if (truth.turn_rate == 0) {  // images are taken on lines; seen along the track, not the swinging bow
      const double sine = std::sin(truth.course), cosine = std::cos(truth.course);
      scorer_.addOffset(time, position.x() * sine + position.y() * cosine, position.x() * cosine - position.y() * sine);
    }
    if (solution.covariance) addConsistency(time, error, *solution.covariance);
  }
  for (const auto& outage : scenario_.sensor(Sensor::Gps).outages)
    if (std::abs(time - outage.end) < kSame) scorer_.addError("outage", position.head<2>().norm());
}

void RunScorer::trace(const NavigationSolution& solution, double time, const Vector<9>& error) {
  const Vector<9> variance = solution.covariance
                                 ? Vector<9>(solution.covariance->diagonal())
                                 : Vector<9>(Vector<9>::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto norm = [&](int first, int size) { return error.segment(first, size).norm(); };
  const auto sum = [&](int first, int size) { return variance.segment(first, size).sum(); };
  Trace& trace = scorer_.trace();
  trace.add(time, norm(kPosition, 2), sum(kPosition, 2));
  if (solution.has_velocity) trace.add("velocity", norm(kVelocity, 3), sum(kVelocity, 3));
  if (solution.has_attitude) {
    trace.add("tilt", norm(kAttitude, 2), sum(kAttitude, 2));
    trace.add("heading", error(kAttitude + 2), variance(kAttitude + 2));
  }
  if (solution.covariance) trace.nees.push_back(fullSquare(error, *solution.covariance));
}

void RunScorer::addConsistency(double time, const Vector<9>& error, const Matrix<9>& P) {
  for (const auto& [name, first] :
       {std::pair("velocity", kVelocity), std::pair("position", kPosition), std::pair("attitude", kAttitude)})
    scorer_.addNees(name, normalisedSquare<3>(error.segment<3>(first), P.block<3, 3>(first, first)), 3);
  scorer_.addNees("full", scorer_.trace().nees.back(), 9);
  const Vector<2> sigma = P.diagonal().segment<2>(kPosition).cwiseSqrt();
  scorer_.addRatio(time, (error.segment<2>(kPosition).array().abs() / sigma.array()).maxCoeff());
}

void RunScorer::add(const Audit& audit, const LabelledAiding& labelled) {
  const double time = secondsBetween(0, audit.stamp);
  if (labelled.reading.sensor == traced_ && audit.effective_size > 0) {
    scorer_.trace().effective_time.push_back(time);
    scorer_.trace().effective_size.push_back(audit.effective_size);
  }
  if (time >= skip_) scorer_.addAudit(time, audit, labelled.outlier);
}

void RunScorer::follow(Estimator& estimator, const Recording& recording) {
  auto labelled = recording.aiding.begin();
  const double seconds = replay(estimator, recording, [&](const Output& output) {
    for (const auto& audit : output.audits)
      if (labelled != recording.aiding.end()) add(audit, *labelled++);
    for (const auto& solution : output.solutions) add(solution);
  });
  scorer_.setCost(seconds, recording.aiding.size());
}

}  // namespace sas_motion::ins
