// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/echo_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sas_motion/imaging/chirp.hpp"
#include "sas_motion/imaging/interpolator.hpp"
#include "sas_motion/math/random.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kMargin = 64;  // samples before the near range and behind the far one, for side lobes and taps

EchoLines emptyLines(const SonarDescription& sonar, const std::vector<EchoPath>& paths, std::size_t pulse_samples) {
  EchoLines echoes;
  echoes.carrier = sonar.carrier;
  echoes.sound_speed = sonar.sound_speed;
  echoes.sample_rate = sonar.sampleRate();
  echoes.first_delay = 2 * sonar.near_range / sonar.sound_speed - kMargin / sonar.sampleRate();
  const double swath = 2 * (sonar.far_range - sonar.near_range) / sonar.sound_speed * sonar.sampleRate();
  echoes.samples = static_cast<int>(std::ceil(swath)) + 2 * kMargin + static_cast<int>(pulse_samples) - 1;
  echoes.paths = paths;
  echoes.data.assign(paths.size() * static_cast<std::size_t>(echoes.samples), {});
  return echoes;
}

bool hidden(const Scene& scene, const EchoPath& path, const Eigen::Vector3d& point) {
  return std::any_of(scene.blocks.begin(), scene.blocks.end(), [&](const Block& block) {
    return block.hides(path.transmitter, point) || block.hides(path.receiver, point);
  });
}

/// What the bottom would answer to an impulse that fills the band.
void addScatterers(Spectrum& line, const EchoLines& echoes, const EchoPath& path, double slant_error,
                   const SonarDescription& sonar, const Scene& scene, const Interpolator& interpolator) {
  for (const auto& scatterer : scene.scatterers) {
    if (hidden(scene, path, scatterer.position)) continue;
    const double length = pathLength(path, scatterer.position, sonar.sound_speed) + 2 * slant_error;
    const double beam = beamAmplitude(path, scatterer.position, sonar);
    const double turns = sonar.carrier / sonar.sound_speed * length;
    interpolator.deposit(line, echoes.position(length),
                         scatterer.amplitude * std::polar(beam, -2 * kPi * (turns - std::floor(turns))));
  }
}

}  // namespace

EchoLines simulateEchoes(const SonarDescription& sonar, const std::vector<EchoPath>& paths, const Scene& scene,
                         const EchoOptions& options) {
  if (!options.slant_errors.empty() && options.slant_errors.size() != paths.size())
    throw std::invalid_argument("simulateEchoes: slant_errors must be empty or one a line");
  Spectrum pulse = chirp(sonar);
  EchoLines echoes = emptyLines(sonar, paths, pulse.size());
  const auto samples = static_cast<std::size_t>(echoes.samples);
  const std::size_t length = fastLength(samples);
  const Interpolator interpolator;
  const std::size_t bottom_samples = samples - pulse.size() + 1;
  pulse.resize(length);
  Fourier(length).forward(pulse);
  forEachTask(paths.size(), options.threads, [&](std::size_t i) {
    Fourier fourier(length);
    Spectrum line(bottom_samples);
    addScatterers(line, echoes, paths[i], options.slant_errors.empty() ? 0 : options.slant_errors[i], sonar, scene,
                  interpolator);
    line.resize(length);
    fourier.forward(line);
    for (std::size_t k = 0; k < length; ++k) line[k] *= pulse[k];
    fourier.inverse(line);
    Random random(options.seed, i);
    for (std::size_t n = 0; n < samples; ++n) {
      if (options.noise > 0)
        line[n] += options.noise * std::sqrt(0.5) * std::complex<double>(random.gaussian(), random.gaussian());
      echoes.line(i)[n] = std::complex<float>(line[n]);
    }
  });
  return echoes;
}

}  // namespace sas_motion::imaging
