// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/statistics.hpp"

namespace sas_motion {

/// A chi-squared gate on the normalised innovation squared (NIS). It accepts a share `probability` of good
/// measurements.
class ChiSquaredGate {
 public:
  explicit ChiSquaredGate(double probability) {
    for (int rows = 0; rows < kMaxRows; ++rows) threshold_[rows] = chiSquaredQuantile(probability, rows + 1);
  }
  /// The largest accepted NIS of a measurement with `rows` (1 to 6) rows.
  double threshold(int rows) const { return threshold_[rows - 1]; }

 private:
  static constexpr int kMaxRows = 6;
  double threshold_[kMaxRows];
};

}  // namespace sas_motion
