// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {

/// sin(pi x) / (pi x)
inline double sinc(double x) { return std::abs(x) < 1e-9 ? 1.0 : std::sin(kPi * x) / (kPi * x); }

/// A sinc times a Kaiser window of `taps` samples. [Kaiser1974]
double kaiserSinc(double x, int taps, double beta);

/// Interpolates a band-limited line by a Kaiser-windowed sinc of 16 taps. For lines sampled at 1.5 times their
/// bandwidth the error is below -75 dB.
class Interpolator {
 public:
  static constexpr int kTaps = 16;
  using Taps = std::array<double, kTaps>;

  Interpolator();
  /// The kernel at a distance of x [samples].
  static double kernel(double x);
  /// Weights of the samples floor(position) - 7 ... floor(position) + 8; `fraction` is position - floor(position).
  Taps taps(double fraction) const;
  /// The line at this position; samples outside the line are zero.
  std::complex<double> at(const std::complex<float>* line, int samples, double position) const;
  /// Adds a band-limited impulse at this position; the part outside the line is lost.
  void deposit(std::vector<std::complex<double>>& line, double position, std::complex<double> amplitude) const;

 private:
  static constexpr int kPhases = 512;
  std::vector<Taps> table_;  // kPhases + 1
};

}  // namespace sas_motion::imaging
