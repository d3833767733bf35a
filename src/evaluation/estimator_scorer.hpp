// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

#include "evaluation/trace.hpp"
#include "evaluation/watches.hpp"
#include "sas_motion/estimate/audit.hpp"
#include "sas_motion/evaluation/aperture.hpp"

namespace sas_motion {

struct ScorerOptions {
  ApertureOptions aperture;
  double speed = 0;               ///< of the aperture error [m/s]; 0: the mean of the speeds that are added
  double epoch = 1;               ///< of the estimator, see LockOut [s]
  std::string_view traced;        ///< the sensor whose audits the trace shows
  bool square_by_degree = false;  ///< divides each square by its degrees of freedom, else their mean: other rounding
};

/// Collects the errors and audits of one estimator over one run, and sums them up. It needs no state: a system computes
/// its errors, names them and hands them over.
class EstimatorScorer {
 public:
  explicit EstimatorScorer(const std::string& estimator = "", const ScorerOptions& options = {})
      : options_(options), lock_out_(options.epoch) {
    facts_.estimator = estimator;
  }

  /// Counts a solution; one that is not finite has diverged.
  void addSample(bool finite);
  /// The size of an error of a group of states.
  void addError(std::string_view group, double size);
  /// The square of an error over its covariance; "full" for all states.
  void addNees(std::string_view group, double square, double degrees) { in(nees_, group).add(square, degrees); }
  /// The same of an innovation.
  void addNis(std::string_view sensor, double square, double degrees) { in(nis_, sensor).add(square, degrees); }
  /// The largest error of a horizontal axis over its standard deviation, see LockOut.
  void addRatio(double time, double ratio) { lock_out_.add(time, ratio); }
  /// The position error along the true heading and across it, and the speed, for the aperture error.
  void addOffset(double time, double along, double across, double speed = 0);
  /// The length of a step of the true way.
  void addDistance(double length) { distance_ += length; }
  /// Whether the simulator labels a measurement, or a row of one, and the estimator flags it.
  void addDetection(std::string_view sensor, bool label, bool flag) { in(detections_, sensor).add(label, flag); }
  /// An audit, with the label of its measurement where there is one.
  void addAudit(double time, const Audit& audit, std::optional<bool> outlier);
  /// An audit, with labels row by row.
  void addAudit(double time, const Audit& audit, const std::array<bool, kMostRows>& outlier);
  void setCost(double seconds, std::size_t updates);

  EstimatorReport report() const;
  Named<ErrorSummary> errors() const;
  Named<Consistency> nees() const { return consistencies(nees_); }
  Named<Consistency> nis() const { return consistencies(nis_); }
  const Named<Detection>& detections() const { return detections_; }
  Detection detection() const;                                              ///< of all sensors
  const std::array<std::size_t, 5>& verdicts() const { return verdicts_; }  ///< by Verdict
  ApertureError aperture() const;
  double drift() const;  ///< horizontal error at the end over the distance [-]

  /// What a system itself finds out: see EstimatorReport.
  EstimatorReport& facts() { return facts_; }
  Trace& trace() { return trace_; }

 private:
  struct Squares {
    void add(double square, double its_degrees) {
      values.push_back(square);
      degrees = its_degrees;
    }
    std::vector<double> values;
    double degrees = 0;
  };
  template <class Value>
  static Value& in(Named<Value>& all, std::string_view name);
  static Named<Consistency> consistencies(const Named<Squares>& all);
  Named<double> meansByDegree(const Named<Squares>& all) const;
  bool take(double time, const Audit& audit, bool outlier);

  ScorerOptions options_;
  EstimatorReport facts_;
  Named<std::vector<double>> errors_;
  Named<Squares> nees_, nis_;
  Named<Detection> detections_;
  std::array<std::size_t, 5> verdicts_{};
  std::vector<double> time_, along_, across_, speeds_;
  double distance_ = 0;
  LockOut lock_out_;
  Trace trace_;
};

}  // namespace sas_motion
