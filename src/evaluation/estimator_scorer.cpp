// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/estimator_scorer.hpp"

#include "sas_motion/math/statistics.hpp"

namespace sas_motion {
namespace {

double leastWeight(const Audit& audit) { return audit.weights.head(audit.rows).minCoeff(); }

}  // namespace

template <class Value>
Value& EstimatorScorer::in(Named<Value>& all, std::string_view name) {
  for (auto& [key, value] : all)
    if (key == name) return value;
  return all.emplace_back(name, Value{}).second;
}

void EstimatorScorer::addSample(bool finite) {
  ++facts_.samples;
  facts_.diverged |= !finite;
}

void EstimatorScorer::addError(std::string_view group, double size) { in(errors_, group).push_back(size); }

void EstimatorScorer::addOffset(double time, double along, double across, double speed) {
  time_.push_back(time);
  along_.push_back(along);
  across_.push_back(across);
  speeds_.push_back(speed);
}

/// Returns whether the measurement reached the filter, so that its label counts.
bool EstimatorScorer::take(double time, const Audit& audit, bool outlier) {
  ++verdicts_[static_cast<std::size_t>(audit.verdict)];
  if (audit.rows == 0) return false;
  in(detections_, audit.sensor);
  if (audit.verdict == Verdict::Stale || audit.verdict == Verdict::Invalid) return false;
  const bool has_nis = audit.nis > 0 || audit.S(0, 0) > 0;
  if (has_nis) addNis(audit.sensor, audit.nis, audit.rows);
  if (audit.sensor == options_.traced)
    trace_.addWeight(time, leastWeight(audit), outlier, has_nis ? audit.nis : std::nan(""));
  return true;
}

void EstimatorScorer::addAudit(double time, const Audit& audit, std::optional<bool> outlier) {
  if (take(time, audit, outlier.value_or(false)) && outlier)
    addDetection(audit.sensor, *outlier, audit.verdict == Verdict::Rejected || leastWeight(audit) < kDownWeighted);
}

void EstimatorScorer::addAudit(double time, const Audit& audit, const std::array<bool, kMostRows>& outlier) {
  if (!take(time, audit, std::any_of(outlier.begin(), outlier.begin() + audit.rows, [](bool row) { return row; })))
    return;
  for (int row = 0; row < audit.rows; ++row)
    addDetection(audit.sensor, outlier[static_cast<std::size_t>(row)], audit.weights(row) < kDownWeighted);
}

void EstimatorScorer::setCost(double seconds, std::size_t updates) {
  facts_.microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, updates));
}

Named<ErrorSummary> EstimatorScorer::errors() const {
  Named<ErrorSummary> all;
  for (const auto& [group, sizes] : errors_) all.emplace_back(group, summarize(sizes));
  return all;
}

Named<Consistency> EstimatorScorer::consistencies(const Named<Squares>& all) {
  Named<Consistency> result;
  for (const auto& [name, squares] : all) result.emplace_back(name, consistency(squares.values, squares.degrees));
  return result;
}

Named<double> EstimatorScorer::meansByDegree(const Named<Squares>& all) const {
  Named<double> means;
  for (const auto& [name, squares] : all) {
    std::vector<double> values = squares.values;
    const double degrees = squares.degrees;
    if (options_.square_by_degree)
      for (double& value : values) value /= degrees;
    means.emplace_back(name, options_.square_by_degree ? mean(values) : mean(values) / degrees);
  }
  return means;
}

Detection EstimatorScorer::detection() const {
  Detection all;
  for (const auto& [sensor, detection] : detections_) all.add(detection);
  return all;
}

ApertureError EstimatorScorer::aperture() const {
  return apertureError(time_, along_, across_, options_.speed > 0 ? options_.speed : mean(speeds_), options_.aperture);
}

double EstimatorScorer::drift() const {
  return distance_ > 0 && !along_.empty() ? std::hypot(along_.back(), across_.back()) / distance_ : 0;
}

EstimatorReport EstimatorScorer::report() const {
  EstimatorReport report = facts_;
  report.locked_out |= lock_out_.lockedOut();
  report.errors = errors();
  report.nees = meansByDegree(nees_);
  if (!nees_.empty()) report.nis = meansByDegree(nis_);  // without a covariance, innovations have none either
  if (!time_.empty()) {
    const ApertureError error = aperture();
    report.aperture_across = error.across;
    if (error.windows > 0) report.aperture_wavelengths = error.across / error.wavelength;
  }
  if (!trace_.effective_size.empty()) report.effective_size = quantile(trace_.effective_size, 0.5);
  report.precision = detection().precision();
  report.recall = detection().recall();
  return report;
}

}  // namespace sas_motion
