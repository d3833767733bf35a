// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ins_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/evaluation/aperture.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kSame = 1e-6;  // [s]

double normalisedSquare(const Vector<3>& error, const Matrix<3>& P) { return error.dot(P.llt().solve(error)) / 3; }

}  // namespace

void Score::add(const TruthSample& truth, const Solution& solution) {
  const double time = secondsBetween(0, solution.stamp);
  const Vector<3> position = displacement(truth.state, solution.state);
  const Vector<3> velocity = solution.state.velocity_nav - truth.state.velocity_nav;
  const Vector<3> phi = attitudeError(solution.state.q_nav_body, truth.state.q_nav_body);
  for (const auto& outage : scenario_.sensor(Sensor::Gps).outages)
    if (std::abs(time - outage.end) < kSame) errors_["outage"].push_back(position.head<2>().norm());
  if (time < skip_) return;
  finite_ &= position.allFinite() && velocity.allFinite();
  errors_["position"].push_back(position.head<2>().norm());
  errors_["height"].push_back(std::abs(position.z()));
  if (solution.moving) errors_["velocity"].push_back(velocity.norm());
  if (solution.lying) {
    errors_["tilt"].push_back(phi.head<2>().norm());
    errors_["heading"].push_back(std::abs(phi.z()));
  }
  if (truth.turn_rate == 0) {  // images are taken on lines; seen along the track, not the swinging bow
    const double sine = std::sin(truth.course), cosine = std::cos(truth.course);
    time_.push_back(time);
    along_.push_back(position.x() * sine + position.y() * cosine);
    across_.push_back(position.x() * cosine - position.y() * sine);
  }
  trace_.time.push_back(time);
  trace_.error.push_back(position.head<2>().norm());
  if (!solution.covariance) return;
  Vector<9> error;
  error << velocity, position, phi;
  addConsistency(error, *solution.covariance);
  const Vector<2> sigma = solution.covariance->diagonal().segment<2>(kPosition).cwiseSqrt();
  trace_.sigma3.push_back(3 * sigma.norm());
  lock_out_.add(time, (position.head<2>().array().abs() / sigma.array()).maxCoeff());
}

void Score::addConsistency(const Vector<9>& error, const Matrix<9>& P) {
  const auto group = [&](State first) { return normalisedSquare(error.segment<3>(first), P.block<3, 3>(first, first)); };
  nees_["velocity"].push_back(group(kVelocity));
  nees_["position"].push_back(group(kPosition));
  nees_["attitude"].push_back(group(kAttitude));
  const Vector<9> scale = P.diagonal().cwiseSqrt(), scaled = error.cwiseQuotient(scale);  // m/s, m and rad are far from alike
  const Matrix<9> correlation = scale.cwiseInverse().asDiagonal() * P * scale.cwiseInverse().asDiagonal();
  const double full = scaled.dot(correlation.llt().solve(scaled));
  nees_["full"].push_back(full / 9);
  trace_.nees.push_back(full);
}

void Score::add(const Audit& audit, const LabelledAiding& labelled) {
  const double time = secondsBetween(0, audit.stamp);
  if (time < skip_ || audit.verdict == Verdict::Stale || audit.verdict == Verdict::Invalid) return;
  nis_[static_cast<std::size_t>(audit.sensor)].push_back(audit.nis / rowsOf(audit.sensor));
  bool outlier = false;
  for (int row = 0; row < rowsOf(audit.sensor); ++row) {
    const bool label = labelled.outlier[static_cast<std::size_t>(row)], flag = audit.weights(row) < kDownWeighted;
    detection_.labelled += label;
    detection_.flagged += flag;
    detection_.hits += label && flag;
    outlier |= label;
  }
  if (audit.sensor != Sensor::Gps) return;
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
  report.samples = trace_.time.size();
  for (const char* group : {"position", "height", "velocity", "tilt", "heading", "outage"})
    if (const auto found = errors_.find(group); found != errors_.end()) report.errors.emplace_back(group, towfish::summarize(found->second));
  for (const auto& [group, values] : nees_) report.nees.emplace_back(group, mean(values));
  for (const auto sensor : {Sensor::Gps, Sensor::Dvl, Sensor::Depth, Sensor::Dpc})
    if (const auto& values = nis_[static_cast<std::size_t>(sensor)]; !values.empty() && !nees_.empty())
      report.nis.emplace_back(sensorName(sensor), mean(values));
  const auto aperture = towfish::apertureError(time_, along_, across_, scenario_.track.speed, aperture_);
  if (aperture.windows > 0) report.aperture_across = aperture.across;
  report.precision = detection_.precision();
  report.recall = detection_.recall();
  return report;
}

}  // namespace sas_motion::ins
