// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/echo_lines.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/interpolator.hpp"
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

std::vector<EchoPath> echoPaths(const SonarDescription& sonar, const std::vector<PingPose>& poses) {
  std::vector<EchoPath> paths;
  paths.reserve(poses.size() * static_cast<std::size_t>(sonar.receivers));
  for (const auto& pose : poses)
    for (int receiver = 0; receiver < sonar.receivers; ++receiver) {
      EchoPath path;
      path.transmitter = pose.position + pose.C_local_body * sonar.transmitter_body;
      path.receiver = pose.position + pose.C_local_body * sonar.receiverBody(receiver);
      if (!sonar.stop_and_hop) path.receiver_velocity = pose.velocity;
      path.forward = pose.C_local_body.col(0);
      paths.push_back(path);
    }
  return paths;
}

double pathLength(const EchoPath& path, const Eigen::Vector3d& point, double sound_speed) {
  const double out = (point - path.transmitter).norm();
  const Eigen::Vector3d back = point - path.receiver;
  const Eigen::Vector3d mach = path.receiver_velocity / sound_speed;
  // |back - mach L| = L - out, with L the whole path: a quadratic in L
  const double a = 1 - mach.squaredNorm(), b = out - back.dot(mach), c = out * out - back.squaredNorm();
  return (b + std::sqrt(b * b - a * c)) / a;
}

bool EchoLines::finite(std::size_t first, std::size_t count) const {
  return std::all_of(line(first), line(first + count), [](const std::complex<float>& value) {
    return std::isfinite(value.real()) && std::isfinite(value.imag());
  });
}

double beamAmplitude(const EchoPath& path, const Eigen::Vector3d& point, const SonarDescription& sonar) {
  const auto element = [&](const Eigen::Vector3d& place) {
    return sinc(sonar.element / sonar.wavelength() * path.forward.dot((point - place).normalized()));
  };
  return element(path.transmitter) * element(path.receiver);
}

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
