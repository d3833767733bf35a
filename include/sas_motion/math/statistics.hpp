// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace sas_motion {

/// Quantile of the chi-squared distribution with `degrees` degrees of freedom.
double chiSquaredQuantile(double probability, double degrees);

/// The band that the average of `count` independent chi-squared variables of `degrees` degrees of freedom stays in with
/// the given `probability`, e.g. 0.95 [BarShalom2001, 5.4.2].
struct Band {
  double lower;
  double upper;
};
Band averageChiSquaredBand(double degrees, double count, double probability);

double rootMeanSquare(const std::vector<double>& values);
double mean(const std::vector<double>& values);
/// The standard error of the mean of independent values; 0 for fewer than two.
double standardError(const std::vector<double>& values);

/// The `fraction` quantile (0 to 1) by linear interpolation between order statistics; 0 where there are no values.
double quantile(std::vector<double> values, double fraction);

}  // namespace sas_motion
