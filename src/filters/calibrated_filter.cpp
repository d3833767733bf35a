// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/calibrated_filter.hpp"

#include <algorithm>

#include "sas_motion/filters/filter_by_name.hpp"

namespace sas_motion {
namespace {

constexpr double kPriorCount = 20;  // readings that the initial values count as
constexpr double kMemory = 300;     // readings in an average at most
constexpr double kLargest = 1;      // variance of a prediction over R that the averages apply to

}  // namespace

void learn(LearnedInfluence& row, const Influence& influence, double t) {
  if (row.readings == 0) row.readings = kPriorCount;
  row.readings = std::min(row.readings + 1, kMemory);
  const auto average = [&row](double& sum, double value) { sum += (value - sum) / row.readings; };
  const double square = (1 + t) * influence.psi * influence.psi;
  const double gain = (1 + t) * influence.slope / (1 + t * influence.slope);
  average(row.weighted, influence.weight * square);
  average(row.clipped, (1 - influence.weight) * square);
  average(row.gain, gain * gain);
}

double noiseThrough(const LearnedInfluence& row, double t, double s) {
  if (t > kLargest) {
    s *= kLargest / t;
    t = kLargest;
  }
  const double square = std::min(row.weighted, (1 + s) / (1 + t)) + row.clipped;  // accepted readings do not increase R
  return std::max(row.gain * row.gain, (1 + t) * square - s * row.gain);  // and no reading is better than a good one
}

SAS_MOTION_FOR_CALIBRATED_FILTERS(, SAS_MOTION_INSTANTIATE_CALIBRATED)

}  // namespace sas_motion
