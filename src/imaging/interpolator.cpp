// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/interpolator.hpp"

#include <algorithm>

namespace sas_motion::imaging {
namespace {

constexpr int kBefore = Interpolator::kTaps / 2 - 1;  // taps before the sample at floor(position)
constexpr double kBeta = 7.6;                         // about 78 dB

/// I_0 by its series, whose terms are all positive. The standard library's calls lgamma, which writes a global variable
/// and so must not be called by two threads.
double besselI0(double x) {
  double sum = 1, term = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) sum += term *= 0.25 * x * x / (k * k);
  return sum;
}

}  // namespace

double kaiserSinc(double x, int taps, double beta) {
  const double u = x / (0.5 * taps);
  if (std::abs(u) >= 1) return 0;
  return sinc(x) * besselI0(beta * std::sqrt(1 - u * u)) / besselI0(beta);
}

double Interpolator::kernel(double x) { return kaiserSinc(x, kTaps, kBeta); }

Interpolator::Interpolator() : table_(kPhases + 1) {
  for (int phase = 0; phase <= kPhases; ++phase)
    for (int tap = 0; tap < kTaps; ++tap)
      table_[phase][tap] = kernel(static_cast<double>(phase) / kPhases + kBefore - tap);
}

Interpolator::Taps Interpolator::taps(double fraction) const {
  const double phase = fraction * kPhases;
  const int below = std::min(static_cast<int>(phase), kPhases - 1);
  const double weight = phase - below;
  Taps result;
  for (int tap = 0; tap < kTaps; ++tap)
    result[tap] = table_[below][tap] + weight * (table_[below + 1][tap] - table_[below][tap]);
  return result;
}

std::complex<double> Interpolator::at(const std::complex<float>* line, int samples, double position) const {
  if (!(position > -kTaps && position < samples + kTaps)) return 0;
  const int base = static_cast<int>(std::floor(position));
  const Taps weights = taps(position - base);
  std::complex<double> sum = 0;
  for (int tap = std::max(0, kBefore - base); tap < std::min(kTaps, samples + kBefore - base); ++tap)
    sum += weights[tap] * std::complex<double>(line[base - kBefore + tap]);
  return sum;
}

void Interpolator::deposit(std::vector<std::complex<double>>& line, double position,
                           std::complex<double> amplitude) const {
  const auto samples = static_cast<int>(line.size());
  if (!(position > -kTaps && position < samples + kTaps)) return;
  const int base = static_cast<int>(std::floor(position));
  const Taps weights = taps(position - base);
  for (int tap = std::max(0, kBefore - base); tap < std::min(kTaps, samples + kBefore - base); ++tap)
    line[base - kBefore + tap] += weights[tap] * amplitude;
}

}  // namespace sas_motion::imaging
