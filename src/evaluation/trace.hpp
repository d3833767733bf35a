// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "evaluation/report.hpp"

namespace sas_motion {

/// An error over the times of a trace and three of its standard deviations [SI]; not a number where it is not known.
struct ErrorSeries {
  std::vector<double> error, sigma3;
};

/// One estimator over one run, for plots.
struct Trace {
  /// Notes the error of the first group and its variance at a new time.
  void add(double at, double value, double variance) {
    time.push_back(at);
    error.push_back(value);
    sigma3.push_back(3 * std::sqrt(variance));
  }

  /// Notes an error of another group and its variance at the latest time.
  void add(const std::string& group, double value, double variance) {
    auto found = std::find_if(others.begin(), others.end(), [&](const auto& other) { return other.first == group; });
    if (found == others.end()) found = others.insert(others.end(), {group, {}});
    found->second.error.push_back(value);
    found->second.sigma3.push_back(3 * std::sqrt(variance));
  }

  /// Notes the weight and the normalised squared innovation of a measurement, and its label.
  void addWeight(double at, double least_weight, bool is_outlier, double squared_innovation) {
    weight_time.push_back(at);
    weight.push_back(least_weight);
    outlier.push_back(is_outlier);
    nis.push_back(squared_innovation);
  }

  std::vector<double> time, error, sigma3;  ///< [s], of the first group, the position or mounting angles [m, rad]
  Named<ErrorSeries> others;                ///< of further groups
  std::vector<double> nees, nis;            ///< not divided by their degrees of freedom
  std::vector<double> weight_time, weight;
  std::vector<bool> outlier;                           ///< the simulator's label of what the weight is of
  std::vector<double> effective_time, effective_size;  ///< [s], of a filter's particles
  int nees_degrees = 0, nis_degrees = 0;
};

}  // namespace sas_motion
