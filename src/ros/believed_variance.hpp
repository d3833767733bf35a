// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace sas_motion::ros_side {

inline bool usableVariance(double variance) { return std::isfinite(variance) && variance > 0; }

/// The variance that is believed of a message's: its own where usable, else the sensor's; not below the floor.
inline double believedVariance(double stated, double sigma, double floor, bool override_message) {
  return std::max(usableVariance(stated) && !override_message ? stated : sigma * sigma, floor * floor);
}

}  // namespace sas_motion::ros_side
