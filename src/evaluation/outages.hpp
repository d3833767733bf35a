// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/true_track.hpp"

namespace sas_motion {

/// A stretch without fixes, and how far off the last estimate was before they came back.
struct Outage {
  double begin = 0, duration = 0;      ///< after the first true point [s]
  double distance = 0, error_end = 0;  ///< [m]
};

/// Gaps between the stamps of fixes that are long enough to count, where truth and estimates lie in them.
std::vector<Outage> outages(const std::vector<Stamp>& fixes, const TrueTrack& truth,
                            const std::vector<Solution>& estimates);

/// What an estimator adds to the stamps of one sensor's readings: the offset of least size at which every audit is of a
/// reading; 0 where there is none. Both are in time order.
Stamp timeOffset(const std::vector<Stamp>& readings, const std::vector<Stamp>& audits);

}  // namespace sas_motion
