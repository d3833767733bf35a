// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/consistency.hpp"

#include <algorithm>

#include "sas_motion/math/statistics.hpp"

namespace sas_motion {
namespace {

std::optional<double> share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::nullopt : std::optional<double>(static_cast<double>(part) / static_cast<double>(whole));
}

}  // namespace

ErrorSummary summarize(const std::vector<double>& errors) {
  return {rootMeanSquare(errors), quantile(errors, 0.95),
          errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end())};
}

Consistency consistency(const std::vector<double>& values, double degrees) {
  Consistency result;
  result.count = values.size();
  result.degrees = degrees;
  if (values.empty()) return result;
  result.mean = mean(values);
  const Band band = averageChiSquaredBand(degrees, static_cast<double>(values.size()), 0.95);
  result.lower = band.lower;
  result.upper = band.upper;
  const Band single = averageChiSquaredBand(degrees, 1, 0.95);
  const auto inside =
      std::count_if(values.begin(), values.end(), [&](double v) { return v >= single.lower && v <= single.upper; });
  result.inside = static_cast<double>(inside) / static_cast<double>(values.size());
  return result;
}

void Detection::add(bool label, bool flag) {
  labelled += label;
  flagged += flag;
  hits += label && flag;
}

void Detection::add(const Detection& other) {
  labelled += other.labelled;
  flagged += other.flagged;
  hits += other.hits;
}

std::optional<double> Detection::precision() const { return share(hits, flagged); }
std::optional<double> Detection::recall() const { return share(hits, labelled); }

}  // namespace sas_motion
