// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/fourier.hpp"

#include <cmath>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {

std::size_t spectralGap(const Spectrum& spectrum) {
  const auto n = static_cast<double>(spectrum.size());
  std::complex<double> centre = 0;
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    centre += std::norm(spectrum[k]) * std::polar(1.0, 2 * kPi * static_cast<double>(k) / n);
  const double gap = n * (std::arg(centre) / (2 * kPi) + 1.5);
  return static_cast<std::size_t>(std::lround(gap)) % spectrum.size();
}

Spectrum oversample(const Spectrum& line, int factor) {
  const std::size_t n = line.size(), fine_n = n * static_cast<std::size_t>(factor);
  Spectrum spectrum = line;
  Fourier(n).forward(spectrum);
  const std::size_t gap = spectralGap(spectrum);
  Spectrum fine(fine_n);
  for (std::size_t k = 0; k < n; ++k) fine[(fine_n - n / 2 + k) % fine_n] = spectrum[(gap + k) % n];
  Fourier(fine_n).inverse(fine);
  for (auto& value : fine) value *= factor;
  return fine;
}

std::complex<double> valueAt(const Spectrum& spectrum, std::size_t gap, double position) {
  const std::size_t n = spectrum.size();
  const double cycle = 2 * kPi / static_cast<double>(n);
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < n; ++k)
    sum +=
        spectrum[(gap + k) % n] * std::polar(1.0 / static_cast<double>(n),
                                             cycle * (static_cast<double>(k) - static_cast<double>(n / 2)) * position);
  return sum;
}

}  // namespace sas_motion::imaging
