// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"

namespace sas_motion {

template <class Value>
using Named = std::vector<std::pair<std::string, Value>>;

/// Whether and when an estimate came near the truth to stay.
struct Convergence {
  std::optional<double> after;  ///< from the start [s]; empty where it never did
};

/// What one estimator made of one simulated run.
struct EstimatorReport {
  std::string estimator;
  bool diverged = false;    ///< an estimate that is not finite
  bool locked_out = false;  ///< see LockOut
  std::size_t samples = 0;
  Named<towfish::ErrorSummary> errors;  ///< by group of states, the position first
  Named<double> nees;                   ///< mean over the run, over its degrees of freedom; "full" for all states
  Named<double> nis;                    ///< by sensor, likewise
  std::optional<double> aperture_across, aperture_wavelengths, precision, recall;
  std::optional<Convergence> convergence;  ///< from a bad start, where a system watches it
  std::optional<double> effective_size;    ///< of a filter's particles, the median over the run
  std::vector<Named<double>> windows;      ///< of imaging, the measures of each aperture's image
  double microseconds = 0;                 ///< CPU time for an update
};

/// An error over the times of a trace and three of its standard deviations [SI]; not a number where it is not known.
struct ErrorSeries {
  std::vector<double> error, sigma3;
};

/// One estimator over one run, for plots.
struct Trace {
  /// Notes an error of a group and its variance at the latest time.
  void add(const std::string& group, double value, double variance) {
    auto found = std::find_if(others.begin(), others.end(), [&](const auto& other) { return other.first == group; });
    if (found == others.end()) found = others.insert(others.end(), {group, {}});
    found->second.error.push_back(value);
    found->second.sigma3.push_back(3 * std::sqrt(variance));
  }

  std::vector<double> time, error, sigma3;  ///< [s], of the first group, the position or mounting angles [m, rad]
  Named<ErrorSeries> others;                ///< of further groups
  std::vector<double> nees, nis;            ///< not divided by their degrees of freedom
  std::vector<double> weight_time, weight;
  std::vector<bool> outlier;                           ///< the simulator's label of what the weight is of
  std::vector<double> effective_time, effective_size;  ///< [s], of a filter's particles
  int nees_degrees = 0, nis_degrees = 0;
};

/// Whether a filter was ever sure of the wrong thing: a position error beyond five of its own standard deviations for
/// more than five epochs.
class LockOut {
 public:
  explicit LockOut(double epoch) : longest_(5 * epoch) {}

  /// `ratio`: the largest error of an axis over its standard deviation. Times rise [s].
  void add(double time, double ratio) {
    const bool wrong = ratio > 5;
    if (wrong && !wrong_) since_ = time;
    wrong_ = wrong;
    locked_out_ |= wrong && time - since_ > longest_ - 1e-9;
  }
  bool lockedOut() const { return locked_out_; }

 private:
  double longest_;
  double since_ = 0;
  bool wrong_ = false;
  bool locked_out_ = false;
};

/// Watches an estimate come near the truth. To have come it must be near without a break for so long up to the end of
/// the run: one that just passes by has not.
class ConvergenceWatch {
 public:
  /// `hold`: the least time that it has to stay [s].
  explicit ConvergenceWatch(double hold) : hold_(hold) {}

  /// Times rise [s].
  void add(double time, bool near) {
    last_ = time;
    if (!near)
      since_.reset();
    else if (!since_)
      since_ = time;
  }
  Convergence result() const { return {since_ && last_ - *since_ >= hold_ - 1e-9 ? since_ : std::nullopt}; }

 private:
  double hold_;
  double last_ = 0;
  std::optional<double> since_;
};

}  // namespace sas_motion
