// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"

namespace sas_motion {

template <class Value>
using Named = std::vector<std::pair<std::string, Value>>;

/// What one estimator made of one simulated run.
struct EstimatorReport {
  std::string estimator;
  bool diverged = false;    ///< an estimate that is not finite
  bool locked_out = false;  ///< see LockOut
  std::size_t samples = 0;
  Named<towfish::ErrorSummary> errors;  ///< by group of states, the position first
  Named<double> nees;                   ///< mean over the run, over its degrees of freedom; "full" for all states
  Named<double> nis;                    ///< by sensor, likewise
  std::optional<double> aperture_across, precision, recall;
  std::vector<Named<double>> windows;  ///< of imaging, the measures of each aperture's image
  double microseconds = 0;             ///< CPU time for an update
};

/// One estimator over one run, for plots.
struct Trace {
  std::vector<double> time, error, sigma3;  ///< [s], position [m], three standard deviations of the position [m]
  std::vector<double> nees, nis;            ///< not divided by their degrees of freedom
  std::vector<double> weight_time, weight;
  std::vector<bool> outlier;  ///< the simulator's label of what the weight is of
  int nees_degrees = 0, nis_degrees = 0;
};

/// Whether a filter was ever sure of the wrong thing: a position error beyond five of its own standard deviations for more than five epochs.
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

}  // namespace sas_motion
