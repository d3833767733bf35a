// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace sas_motion {

/// The mixture of one row of a reading under one hypothesis of the bank.
///
/// The innovation's density is sum p_j N(0, v + s_j r), where `stickiness` makes the wide scales likelier and a part of
/// them repeats the last residual. Only the narrow scales update the state.
struct BankReading {
  static constexpr int kScales = 4;
  static constexpr int kNarrow = 2;  ///< scales that update the state; the others are outliers
  using Scales = std::array<double, kScales>;

  double likelihood = 0;
  double inverse = 0;          ///< E[1 / S] over the narrow scales
  double inverse_squared = 0;  ///< E[1 / S^2] over the narrow scales
  double doubt = 0;            ///< probability that it is an outlier
  double agreement = 0;        ///< probability that an outlier repeats the last one
  Scales shares{};             ///< posterior probabilities of the scales

  struct Expectation {
    Scales scales, probabilities;
    double sticky, repeat;
    double stickiness;  ///< 0 to 1: how much the previous reading determines this one
    double residual;    ///< the last one
    double growth;      ///< of the prediction's variance since then
  };

  BankReading(double innovation, double v, double r, const Expectation& e) {
    const double wide = e.probabilities[2] + e.probabilities[3];
    const double outlier = wide + std::max(0.0, e.sticky - wide) * e.stickiness;
    Scales density;
    for (std::size_t j = 0; j < kScales; ++j) {
      const double S = v + r * e.scales[j];
      density[j] = normal(innovation, S);
      shares[j] = e.probabilities[j] * density[j] * (j < kNarrow ? (1 - outlier) / (1 - wide) : 1 / wide);
      if (j >= kNarrow) continue;
      likelihood += shares[j];
      inverse += shares[j] / S;
      inverse_squared += shares[j] / (S * S);
    }
    const double again = normal(innovation - e.residual, 2 * r + e.growth), anew = shares[2] + shares[3] + kTiny;
    const double same = e.repeat * e.stickiness;
    const double explained = outlier * ((1 - same) * anew + same * again) + kTiny;
    likelihood += explained;
    inverse /= likelihood;
    inverse_squared /= likelihood;
    doubt = explained / likelihood;
    agreement = again / (again + anew);
    for (std::size_t j = 0; j < kScales; ++j)
      shares[j] = j < kNarrow ? shares[j] / likelihood : doubt * shares[j] / anew;
  }

 private:
  static constexpr double kTiny = 1e-300;  // avoids 0 / 0 where no scale explains the innovation
  static double normal(double d, double variance) { return std::exp(-0.5 * d * d / variance) / std::sqrt(variance); }
};

}  // namespace sas_motion
