// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "sas_motion/math/statistics.hpp"

namespace sas_motion::towfish {

/// The NEES of an estimator over many runs of one scenario, time by time. Errors of one run are correlated in time, errors of different runs
/// are independent: so the band is that of the average over the runs at one time [BarShalom2001, 5.4.2].
struct EnsembleConsistency {
  std::size_t times = 0;
  Band band{0, 0};    ///< 95 % of the averages lie in it where the covariances are right
  double inside = 0;  ///< share of the times at which the average does
};

/// `runs[i][k]` is the NEES of run i at time k, a chi-squared variable of `degrees` degrees of freedom where the covariances are right. A time
/// at which some run has none (NaN) is left out.
EnsembleConsistency ensembleConsistency(const std::vector<std::vector<double>>& runs, double degrees);

}  // namespace sas_motion::towfish
