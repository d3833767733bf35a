// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>

namespace sas_motion {

double chiSquaredQuantile(double probability, double degrees) {
  return boost::math::quantile(boost::math::chi_squared(degrees), probability);
}

Band averageChiSquaredBand(double degrees, double count, double probability) {
  const double tail = 0.5 * (1 - probability);
  return {chiSquaredQuantile(tail, degrees * count) / count, chiSquaredQuantile(1 - tail, degrees * count) / count};
}

double rootMeanSquare(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

double mean(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standardError(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const auto n = static_cast<double>(values.size());
  const double centre = mean(values);
  const auto add_square = [&](double sum, double value) { return sum + (value - centre) * (value - centre); };
  return std::sqrt(std::accumulate(values.begin(), values.end(), 0.0, add_square) / (n - 1) / n);
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const double position = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(position);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[static_cast<std::size_t>(below)];
  if (below + 1 >= static_cast<std::ptrdiff_t>(values.size())) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + (position - static_cast<double>(below)) * (high - low);
}

}  // namespace sas_motion
