// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace sas_motion {

/// The density of a noise: a mixture of zero-mean Gaussians, some of them with an exponential added.
class NoiseDensity {
 public:
  /// Multiplies the noise by K with probability epsilon.
  void contaminate(double epsilon, double K);
  /// Divides it by sqrt(chi^2_nu / nu): a fine quadrature over the logarithm of the scale.
  void studentise(double nu);
  /// Adds an exponential of this mean with some probability; false where one is there already.
  bool delay(double probability, double mean);
  void scale(double sigma);

  /// Fisher information of the location [Huber1981, 4.5]: the integral of f'^2 / f; rounded to multiples of `quantum`,
  /// whose phase is uniform, of (f(x + q) - f(x))^2 / (F(x + q) - F(x)) / q.
  double information(double quantum = 0) const;
  /// Of a vector of n states with one common scale: its information matrix is this times the identity. No exponentials.
  double radialInformation(int n) const;

 private:
  struct Part {
    double variance = 1, probability = 1, mean = 0;
  };
  struct Value {
    double f = 0, slope = 0, below = 0, above = 0;  ///< density, its derivative, and the probability on either side
  };
  Value at(double x) const;
  double widest() const;

  std::vector<Part> parts_ = std::vector<Part>(1);
};

}  // namespace sas_motion
