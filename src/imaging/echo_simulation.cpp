// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/echo_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/interpolator.hpp"
#include "sas_motion/imaging/sonar.hpp"
#include "sas_motion/math/random.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

/// Adds speckle on the rectangle corner + [0,1] a + [0,1] b, of this power an area, except inside blocks.
void addRectangle(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  double density, double power, Random& random) {
  const double area = std::sqrt(std::max(0.0, a.squaredNorm() * b.squaredNorm() - std::pow(a.dot(b), 2)));
  const auto count = static_cast<std::size_t>(std::lround(area * density));
  const double sigma = std::sqrt(power / density / 2);
  for (std::size_t i = 0; i < count; ++i) {
    const double along_a = random.uniform(), along_b = random.uniform();
    const double real = sigma * random.gaussian(), imaginary = sigma * random.gaussian();
    const Eigen::Vector3d place = corner + along_a * a + along_b * b;
    const auto covers = [&](const Block& block) {  // the bottom under a block, and only that
      return place.z() < block.upper.z() && (place.head<2>().array() > block.lower.head<2>().array()).all() &&
             (place.head<2>().array() < block.upper.head<2>().array()).all();
    };
    if (std::none_of(scene.blocks.begin(), scene.blocks.end(), covers))
      scene.scatterers.push_back({place, {real, imaginary}});
  }
}

/// A block's five visible faces.
void addFaces(Scene& scene, const Block& block, double density, double power, Random& random) {
  const Eigen::Vector3d size = block.upper - block.lower;
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  addRectangle(scene, block.lower, x, z, density, power, random);
  addRectangle(scene, block.lower + y, x, z, density, power, random);
  addRectangle(scene, block.lower, y, z, density, power, random);
  addRectangle(scene, block.lower + x, y, z, density, power, random);
  addRectangle(scene, block.lower + z, x, y, density, power, random);
}

constexpr int kMargin = 64;  // samples before the near range and beyond the far one, for side lobes and taps

EchoLines emptyLines(const SonarDescription& sonar, const std::vector<EchoPath>& paths, std::size_t pulse_samples) {
  const double first_delay = 2 * sonar.near_range / sonar.sound_speed - kMargin / sonar.sampleRate();
  const double swath = 2 * (sonar.far_range - sonar.near_range) / sonar.sound_speed * sonar.sampleRate();
  const int samples = static_cast<int>(std::ceil(swath)) + 2 * kMargin + static_cast<int>(pulse_samples) - 1;
  EchoLines echoes{sonar.carrier, sonar.sound_speed, sonar.sampleRate(), first_delay, samples, 0, paths};
  echoes.data.assign(paths.size() * static_cast<std::size_t>(echoes.samples), {});
  return echoes;
}

bool hidden(const Scene& scene, const EchoPath& path, const Eigen::Vector3d& point) {
  return std::any_of(scene.blocks.begin(), scene.blocks.end(), [&](const Block& block) {
    return block.hides(path.transmitter, point) || block.hides(path.receiver, point);
  });
}

/// Adds the bottom's response to an impulse that fills the band.
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

bool Block::hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  constexpr double kSkin = 1e-6;  // a face does not hide itself
  const Eigen::Vector3d way = to - from;
  double enter = 0, leave = 1;  // the slab test, over the share of the way
  for (int axis = 0; axis < 3; ++axis) {
    if (way(axis) == 0) {
      if (from(axis) <= lower(axis) || from(axis) >= upper(axis)) return false;
      continue;
    }
    const double a = (lower(axis) - from(axis)) / way(axis), b = (upper(axis) - from(axis)) / way(axis);
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return (std::min(leave, 1.0) - enter) * way.norm() > kSkin;
}

Scene speckleScene(const SpeckleOptions& options, const std::vector<Block>& blocks, std::uint64_t seed) {
  Scene scene;
  scene.blocks = blocks;
  Random bottom(seed, 1), faces(seed, 2);
  const Eigen::Vector3d size = options.upper - options.lower;
  addRectangle(scene, options.lower, {size.x(), 0, 0}, {0, size.y(), 0}, options.density, 1, bottom);
  for (const auto& block : blocks) addFaces(scene, block, options.density, options.block_contrast, faces);
  return scene;
}

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
