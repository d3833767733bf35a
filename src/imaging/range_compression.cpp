// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/range_compression.hpp"

#include <atomic>
#include <cmath>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/sonar.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

double window(RangeWindow kind, double share_of_band) {  // -1/2 ... 1/2
  return kind == RangeWindow::Hamming ? 0.54 + 0.46 * std::cos(2 * kPi * share_of_band) : 1.0;
}

/// The filter's spectrum, scaled so that the peak of an echo is the scatterer's amplitude.
Spectrum filterSpectrum(const SonarDescription& sonar, std::size_t length, const CompressionOptions& options) {
  Spectrum pulse = chirp(sonar);
  pulse.resize(length);
  Fourier fourier(length);
  fourier.forward(pulse);
  Spectrum filter(length);
  double peak = 0;
  for (std::size_t k = 0; k < length; ++k) {
    const double share = fourier.frequency(k) * sonar.oversampling;
    if (std::abs(share) > 0.5) continue;
    filter[k] = window(options.window, share) * std::conj(pulse[k]);
    if (options.filter == RangeFilter::Equalized) filter[k] /= std::norm(pulse[k]);
    peak += std::real(filter[k] * pulse[k]) / static_cast<double>(length);
  }
  for (auto& value : filter) value /= peak;
  return filter;
}

}  // namespace

EchoLines compressRange(const EchoLines& raw, const SonarDescription& sonar, const CompressionOptions& options) {
  const int samples = raw.samples - static_cast<int>(chirp(sonar).size()) + 1;
  EchoLines compressed{raw.carrier, raw.sound_speed, raw.sample_rate, raw.first_delay, samples, 0, raw.paths};
  compressed.data.assign(raw.paths.size() * static_cast<std::size_t>(compressed.samples), {});
  const std::size_t length = fastLength(static_cast<std::size_t>(raw.samples));
  const Spectrum filter = filterSpectrum(sonar, length, options);
  std::atomic<std::size_t> left_out{0};
  forEachTask(raw.paths.size(), options.threads, [&](std::size_t i) {
    if (!raw.finite(i, 1)) {
      ++left_out;
      return;
    }
    Fourier fourier(length);
    Spectrum line(length);
    for (int n = 0; n < raw.samples; ++n) line[static_cast<std::size_t>(n)] = raw.line(i)[n];
    fourier.forward(line);
    for (std::size_t k = 0; k < length; ++k) line[k] *= filter[k];
    fourier.inverse(line);
    for (int n = 0; n < compressed.samples; ++n)
      compressed.line(i)[n] = std::complex<float>(line[static_cast<std::size_t>(n)]);
  });
  compressed.left_out = left_out;
  return compressed;
}

}  // namespace sas_motion::imaging
