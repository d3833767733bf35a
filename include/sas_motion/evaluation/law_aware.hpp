// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// Whether the reference knows how large bursts are, or only that they come.
enum class BurstSize { Known, Unknown };

/// Options of a GaussianSumFilter that knows the laws its data are drawn from, as far as Gaussian terms express them.
///
/// Student's t and multipath become Gaussians by quantiles, varying sigma a mixture over its phases, rounding a
/// variance. Bursts become a bias mode of each row; frozen, step and ramp one of unknown size, the last two once in
/// 1000 s (their times are not known). Several such laws share one mode of unknown size. Correlated noise counts as
/// white, dropouts need nothing. A manoeuvre keeps its scale from epoch to epoch of `period` seconds, the time between
/// updates. Process noise that is drawn for each state and step counts by its mean variance: there are too many
/// branches to follow.
GaussianSumOptions lawAware(const NoiseMix& measurement, const NoiseMix& process, double period,
                            BurstSize bursts = BurstSize::Unknown);

/// Student's t as Gaussians: their variances are the inverse mean precisions between quantiles.
std::vector<NoiseTerm> studentTerms(double nu);

}  // namespace sas_motion
