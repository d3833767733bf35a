// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/scores.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/evaluation/aperture.hpp"

namespace sas_motion::towfish {
namespace {

/// The states of a group; -1 where there is no second one.
constexpr std::array<std::array<int, 2>, kGroups> kStatesOf{
    {{kNorth, kEast}, {kHeading, -1}, {kSpeed, -1}, {kCurrentNorth, kCurrentEast}}};

bool known(Group group, const Reference& truth) {
  switch (group) {
    case kHeadingGroup: return truth.heading_known;
    case kSpeedGroup: return truth.speed_known;
    case kCurrentGroup: return truth.current_known;
    default: return true;
  }
}

double normalisedSquare(Group group, const StateVector& error, const StateMatrix& P) {
  const auto [a, b] = kStatesOf[group];
  if (b < 0) return error(a) * error(a) / P(a, a);
  Matrix<2> block;
  block << P(a, a), P(a, b), P(b, a), P(b, b);
  const Vector<2> e(error(a), error(b));
  return e.dot(block.llt().solve(e));
}

}  // namespace

const char* groupName(Group group) {
  constexpr std::array<const char*, kGroups> names{"position", "heading", "speed", "current"};
  return names[group];
}

ErrorSummary summarize(const std::vector<double>& errors) {
  return {rootMeanSquare(errors), quantile(errors, 0.95),
          errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end())};
}

Consistency consistency(const std::vector<double>& values, double degrees) {
  Consistency result;
  result.count = values.size();
  result.degrees = degrees;
  if (values.empty()) return result;
  result.mean = mean(values);
  const Band band = averageChiSquaredBand(degrees, static_cast<double>(values.size()), 0.95);
  result.lower = band.lower;
  result.upper = band.upper;
  const Band single = averageChiSquaredBand(degrees, 1, 0.95);
  const auto inside =
      std::count_if(values.begin(), values.end(), [&](double v) { return v >= single.lower && v <= single.upper; });
  result.inside = static_cast<double>(inside) / static_cast<double>(values.size());
  return result;
}

std::optional<double> Detection::precision() const {
  return flagged == 0 ? std::nullopt : std::optional<double>(static_cast<double>(hits) / static_cast<double>(flagged));
}

std::optional<double> Detection::recall() const {
  return labelled == 0 ? std::nullopt
                       : std::optional<double>(static_cast<double>(hits) / static_cast<double>(labelled));
}

double normalisedSquare(const Estimate& estimate, const Reference& truth) {
  const StateVector error = Model::difference(estimate.belief.mean, truth.state);
  return error.dot(estimate.belief.covariance.llt().solve(error));
}

void Scorer::add(const Estimate& estimate, const Reference& truth) {
  const StateVector error = Model::difference(estimate.belief.mean, truth.state);
  const StateMatrix& P = estimate.belief.covariance;
  if (scores_.samples > 0) scores_.distance += (truth.state - last_truth_).head<2>().norm();
  last_truth_ = truth.state;
  ++scores_.samples;
  if (!estimate.belief.mean.allFinite() || !P.allFinite()) {
    scores_.diverged = true;
    return;
  }
  for (int i = 0; i < kGroups; ++i) {
    const auto group = static_cast<Group>(i);
    if (!known(group, truth)) continue;
    const auto [a, b] = kStatesOf[group];
    errors_[group].push_back(b < 0 ? std::abs(error(a)) : std::hypot(error(a), error(b)));
    if (P(a, a) > 0) nees_[group].push_back(normalisedSquare(group, error, P));  // zero is unknown
  }
  if (truth.heading_known && truth.speed_known && truth.current_known)
    nees_full_.push_back(normalisedSquare(estimate, truth));
  const double heading = truth.heading_known ? truth.state(kHeading) : estimate.belief.mean(kHeading);
  const double c = std::cos(heading), s = std::sin(heading);
  time_.push_back(static_cast<double>(estimate.stamp - 0) * 1e-9);
  along_.push_back(c * error(kNorth) + s * error(kEast));
  across_.push_back(c * error(kEast) - s * error(kNorth));
  speeds_.push_back(truth.speed_known ? truth.state(kSpeed) : estimate.belief.mean(kSpeed));
}

void AuditTally::add(Verdict verdict, double least_weight, std::optional<double> normalised,
                     std::optional<bool> outlier) {
  if (verdict == Verdict::Stale || verdict == Verdict::Invalid) return;
  if (normalised) nis.push_back(*normalised);
  if (!outlier) return;
  const bool flagged = verdict == Verdict::Rejected || least_weight < kDownWeighted;
  detection.labelled += *outlier;
  detection.flagged += flagged;
  detection.hits += *outlier && flagged;
}

void Scorer::add(const Audit& audit, std::optional<bool> outlier) {
  ++scores_.verdicts[static_cast<std::size_t>(audit.verdict)];
  if (audit.rows == 0) return;
  const auto nis = audit.S(0, 0) > 0 ? std::optional(audit.nis) : std::nullopt;
  tallies_[static_cast<std::size_t>(audit.sensor)].add(audit.verdict, audit.weights.head(audit.rows).minCoeff(), nis,
                                                       outlier);
}

Scores Scorer::scores() const {
  Scores result = scores_;
  for (std::size_t i = 0; i < kGroups; ++i) {
    if (errors_[i].empty()) continue;
    result.error[i] = summarize(errors_[i]);
    if (!nees_[i].empty()) result.nees[i] = consistency(nees_[i], kStatesOf[i][1] < 0 ? 1 : 2);
  }
  if (!nees_full_.empty()) result.nees_full = consistency(nees_full_, kStates);
  for (std::size_t i = 0; i < kSensors; ++i)
    if (!tallies_[i].nis.empty()) result.nis[i] = consistency(tallies_[i].nis, rowsOf(static_cast<Sensor>(i)));
  for (std::size_t i = 0; i < kSensors; ++i) result.detection[i] = tallies_[i].detection;
  if (!along_.empty()) {
    result.drift = result.distance > 0 ? std::hypot(along_.back(), across_.back()) / result.distance : 0;
    result.aperture = apertureError(time_, along_, across_, mean(speeds_), aperture_);
  }
  return result;
}

}  // namespace sas_motion::towfish
