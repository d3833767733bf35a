// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/gaussian_sum_filter.hpp"

namespace sas_motion {

/// One row of a measurement, about the summary's mean before the first row is fused.
template <int N>
struct GaussianSumRow {
  Vector<N> h;
  double innovation, r;
  std::uint32_t mode = 0;       ///< its bit in Hypothesis::biased; 0: never biased
  double begins = 0, ends = 0;  ///< probabilities that its mode began or ended since its last evaluation

  /// Opens a branch for each term of the row's noise and keeps those of largest weight. Returns the row's weight, the
  /// expected 1 / variance.
  double fuse(GaussianBlock<N>& block, const GaussianSumOptions& options) const;
};

}  // namespace sas_motion
