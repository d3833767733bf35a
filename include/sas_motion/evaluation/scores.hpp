// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/towfish/estimator.hpp"

namespace sas_motion::towfish {

/// Root mean square, 95th percentile and largest of an error's size.
struct ErrorSummary {
  double rmse = 0, p95 = 0, max = 0;
};
ErrorSummary summarize(const std::vector<double>& errors);

/// An average of normalised squared errors (NEES) or innovations (NIS), the 95 % band that it lies in when the
/// covariances are right and the samples independent, and the fraction of single values inside their own 95 % interval.
struct Consistency {
  double mean = 0, degrees = 0, lower = 0, upper = 0, inside = 0;
  std::size_t count = 0;
};
Consistency consistency(const std::vector<double>& values, double degrees);

/// Down-weighting or rejection against the simulator's labels.
struct Detection {
  std::size_t labelled = 0, flagged = 0, hits = 0;
  std::optional<double> precision() const;
  std::optional<double> recall() const;
};

/// One sensor's audits, summed up.
struct AuditTally {
  std::vector<double> nis;
  Detection detection;
  /// `outlier` is the simulator's label of any of the rows, where there is one; nothing is known of the NIS where an
  /// estimator has none.
  void add(Verdict verdict, double least_weight, std::optional<double> normalised, std::optional<bool> outlier);
};

/// A stretch without fixes, and how far off the estimate was at its end.
struct Outage {
  double begin = 0, duration = 0, distance = 0, error_end = 0;
};

/// RMS position error over windows of one synthetic aperture, after removing mean and linear trend in each: what
/// focusing feels.
struct ApertureError {
  double time = 0, wavelength = 0;
  std::size_t windows = 0;
  double across = 0, along = 0;  ///< across the heading (line of sight) and along it [m]
};

/// The synthetic aperture sonar that the aperture error is meant for: T_a = range wavelength / (element speed).
struct ApertureOptions {
  double range = 100;         ///< slant range r0 [m]
  double wavelength = 0.015;  ///< [m]
  double element = 0.1;       ///< length of the array element D [m]
};

/// The state groups that are scored on their own.
enum Group { kPositionGroup, kHeadingGroup, kSpeedGroup, kCurrentGroup, kGroups };
const char* groupName(Group group);

struct Scores {
  std::size_t samples = 0;
  bool diverged = false;                                   ///< not finite
  std::array<std::optional<ErrorSummary>, kGroups> error;  ///< [m, rad, m/s, m/s]
  std::array<std::optional<Consistency>, kGroups> nees;
  std::optional<Consistency> nees_full;  ///< all six states
  std::array<std::optional<Consistency>, kSensors> nis;
  std::array<Detection, kSensors> detection;
  std::array<std::size_t, 5> verdicts{};  ///< by Verdict
  double distance = 0, drift = 0;         ///< travelled [m]; error at the end over it [-]
  ApertureError aperture;
};

/// True state interpolated at an estimate's stamp, with what is known of it.
struct Reference {
  StateVector state;
  bool heading_known = true, speed_known = true, current_known = true;
};

/// Normalised squared error of all six states.
double normalisedSquare(const Estimate& estimate, const Reference& truth);

/// Collects one estimator's errors over a run, estimate by estimate, and sums them up.
class Scorer {
 public:
  explicit Scorer(const ApertureOptions& aperture = {}) : aperture_(aperture) {}

  void add(const Estimate& estimate, const Reference& truth);
  /// `outlier` is the simulator's label of any of the rows, where there is one.
  void add(const Audit& audit, std::optional<bool> outlier);
  Scores scores() const;

 private:
  ApertureOptions aperture_;
  std::array<std::vector<double>, kGroups> errors_, nees_;
  std::vector<double> nees_full_;
  std::array<AuditTally, kSensors> tallies_;
  Scores scores_;
  std::vector<double> time_, along_, across_;
  std::vector<double> speeds_;
  StateVector last_truth_ = StateVector::Zero();
};

}  // namespace sas_motion::towfish
