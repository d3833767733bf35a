// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sas_motion/evaluation/aperture.hpp"
#include "sas_motion/math/statistics.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kSame = 1e-6;  // [s]

double normalisedSquare(const Vector<3>& error, const Matrix<3>& P) { return error.dot(P.llt().solve(error)) / 3; }

/// Of all nine together, not divided; each is scaled by its own deviation first: m/s, m and rad are far from alike.
double fullSquare(const Vector<9>& error, const Matrix<9>& P) {
  const Vector<9> scale = P.diagonal().cwiseSqrt(), scaled = error.cwiseQuotient(scale);
  const Matrix<9> correlation = scale.cwiseInverse().asDiagonal() * P * scale.cwiseInverse().asDiagonal();
  return scaled.dot(correlation.llt().solve(scaled));
}

}  // namespace

void Score::add(const TruthSample& truth, const NavigationSolution& solution) {
  const double time = secondsBetween(0, solution.stamp);
  Vector<9> error;
  error << solution.state.velocity_nav - truth.state.velocity_nav, displacement(truth.state, solution.state),
      attitudeError(solution.state.q_nav_body, truth.state.q_nav_body);
  const Vector<3> velocity = error.segment<3>(kVelocity), position = error.segment<3>(kPosition),
                  phi = error.segment<3>(kAttitude);
  for (const auto& outage : scenario_.sensor(Sensor::Gps).outages)
    if (std::abs(time - outage.end) < kSame) errors_["outage"].push_back(position.head<2>().norm());
  trace(solution, time, error);
  if (time < skip_) return;
  finite_ &= position.allFinite() && velocity.allFinite();
  errors_["position"].push_back(position.head<2>().norm());
  errors_["height"].push_back(std::abs(position.z()));
  if (solution.has_velocity) errors_["velocity"].push_back(velocity.norm());
  if (solution.has_attitude) {
    errors_["tilt"].push_back(phi.head<2>().norm());
    errors_["heading"].push_back(std::abs(phi.z()));
  }
  if (truth.turn_rate == 0) {  // images are taken on lines; seen along the track, not the swinging bow
    const double sine = std::sin(truth.course), cosine = std::cos(truth.course);
    time_.push_back(time);
    along_.push_back(position.x() * sine + position.y() * cosine);
    across_.push_back(position.x() * cosine - position.y() * sine);
  }
  if (solution.covariance) addConsistency(time, error, *solution.covariance);
}

void Score::trace(const NavigationSolution& solution, double time, const Vector<9>& error) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const Vector<9> variance =
      solution.covariance ? Vector<9>(solution.covariance->diagonal()) : Vector<9>(Vector<9>::Constant(unknown));
  const auto norm = [&](int first, int size) { return error.segment(first, size).norm(); };
  const auto sum = [&](int first, int size) { return variance.segment(first, size).sum(); };
  trace_.time.push_back(time);
  trace_.error.push_back(norm(kPosition, 2));
  trace_.sigma3.push_back(3 * std::sqrt(sum(kPosition, 2)));
  if (solution.has_velocity) trace_.add("velocity", norm(kVelocity, 3), sum(kVelocity, 3));
  if (solution.has_attitude) {
    trace_.add("tilt", norm(kAttitude, 2), sum(kAttitude, 2));
    trace_.add("heading", error(kAttitude + 2), variance(kAttitude + 2));
  }
  if (solution.covariance) trace_.nees.push_back(fullSquare(error, *solution.covariance));
}

void Score::addConsistency(double time, const Vector<9>& error, const Matrix<9>& P) {
  const auto group = [&](State first) {
    return normalisedSquare(error.segment<3>(first), P.block<3, 3>(first, first));
  };
  nees_["velocity"].push_back(group(kVelocity));
  nees_["position"].push_back(group(kPosition));
  nees_["attitude"].push_back(group(kAttitude));
  nees_["full"].push_back(trace_.nees.back() / 9);
  const Vector<2> sigma = P.diagonal().segment<2>(kPosition).cwiseSqrt();
  lock_out_.add(time, (error.segment<2>(kPosition).array().abs() / sigma.array()).maxCoeff());
}

void Score::add(const Audit& audit, const LabelledAiding& labelled) {
  const double time = secondsBetween(0, audit.stamp);
  if (labelled.reading.sensor == traced_ && audit.effective_size > 0) {
    trace_.effective_time.push_back(time);
    trace_.effective_size.push_back(audit.effective_size);
  }
  if (time < skip_ || audit.verdict == Verdict::Stale || audit.verdict == Verdict::Invalid) return;
  nis_[static_cast<std::size_t>(labelled.reading.sensor)].push_back(audit.nis / audit.rows);
  bool outlier = false;
  for (int row = 0; row < audit.rows; ++row) {
    const bool label = labelled.outlier[static_cast<std::size_t>(row)], flag = audit.weights(row) < kDownWeighted;
    detection_.labelled += label;
    detection_.flagged += flag;
    detection_.hits += label && flag;
    outlier |= label;
  }
  if (labelled.reading.sensor != traced_) return;
  trace_.weight_time.push_back(time);
  trace_.weight.push_back(audit.weights.minCoeff());
  trace_.outlier.push_back(outlier);
  trace_.nis.push_back(audit.nis);
}

EstimatorReport Score::report(const std::string& name) const {
  EstimatorReport report;
  report.estimator = name;
  report.diverged = !finite_;
  report.locked_out = lock_out_.lockedOut();
  if (const auto scored = errors_.find("position"); scored != errors_.end()) report.samples = scored->second.size();
  for (const char* group : {"position", "height", "velocity", "tilt", "heading", "outage"})
    if (const auto found = errors_.find(group); found != errors_.end())
      report.errors.emplace_back(group, towfish::summarize(found->second));
  for (const auto& [group, values] : nees_) report.nees.emplace_back(group, mean(values));
  for (const auto sensor : {Sensor::Gps, Sensor::Dvl, Sensor::Depth, Sensor::Dpc})
    if (const auto& values = nis_[static_cast<std::size_t>(sensor)]; !values.empty() && !nees_.empty())
      report.nis.emplace_back(sensorName(sensor), mean(values));
  const auto aperture = towfish::apertureError(time_, along_, across_, scenario_.track.speed, aperture_);
  if (aperture.windows > 0) {
    report.aperture_across = aperture.across;
    report.aperture_wavelengths = aperture.across / aperture.wavelength;
  }
  if (!trace_.effective_size.empty()) report.effective_size = quantile(trace_.effective_size, 0.5);
  report.precision = detection_.precision();
  report.recall = detection_.recall();
  return report;
}

}  // namespace sas_motion::ins
