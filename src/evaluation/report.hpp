// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sas_motion/evaluation/consistency.hpp"

namespace sas_motion {

template <class Value>
using Named = std::vector<std::pair<std::string, Value>>;

/// Whether and when an estimate came near the truth to stay.
struct Convergence {
  std::optional<double> after;  ///< from the start [s]; empty where it never did
};

/// The scores of one estimator over one simulated run.
struct EstimatorReport {
  std::string estimator;
  bool diverged = false;    ///< an estimate that is not finite
  bool locked_out = false;  ///< see LockOut
  std::size_t samples = 0;
  Named<ErrorSummary> errors;  ///< by group of states, the position first
  Named<double> nees;          ///< mean over the run, over its degrees of freedom; "full" for all states
  Named<double> nis;           ///< the same of innovations, by sensor
  std::optional<double> aperture_across, aperture_wavelengths, precision, recall;
  std::optional<Convergence> convergence;  ///< from a bad start, where a system watches it
  std::optional<double> effective_size;    ///< of a filter's particles, the median over the run
  std::vector<Named<double>> windows;      ///< of imaging, the measures of each aperture's image
  double microseconds = 0;                 ///< CPU time for an update
};

}  // namespace sas_motion
