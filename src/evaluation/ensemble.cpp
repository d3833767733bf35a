// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/ensemble.hpp"

#include <cmath>

namespace sas_motion::towfish {
namespace {

/// The average over the runs at a time; NaN where one of them has none.
double averageAt(std::size_t time, const std::vector<std::vector<double>>& runs) {
  double sum = 0;
  for (const auto& run : runs) sum += time < run.size() ? run[time] : NAN;
  return sum / static_cast<double>(runs.size());
}

}  // namespace

EnsembleConsistency ensembleConsistency(const std::vector<std::vector<double>>& runs, double degrees) {
  EnsembleConsistency result;
  if (runs.empty()) return result;
  result.band = averageChiSquaredBand(degrees, static_cast<double>(runs.size()), 0.95);
  std::size_t inside = 0;
  for (std::size_t time = 0; time < runs.front().size(); ++time) {
    const double average = averageAt(time, runs);
    if (std::isnan(average)) continue;
    ++result.times;
    inside += average >= result.band.lower && average <= result.band.upper;
  }
  if (result.times > 0) result.inside = static_cast<double>(inside) / static_cast<double>(result.times);
  return result;
}

}  // namespace sas_motion::towfish
