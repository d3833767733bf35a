// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pulses times pixels a second: backproject() on one and two threads beside a plain loop in double, all in one run. Each figure is the best of several short
// repeats, because the cores may be shared. usage: backprojection_speed [REPEATS]
#include <fmt/format.h>
#include <hwy/targets.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/factorized_backprojection.hpp"
#include "sas_motion/imaging/range_compression.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/random.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;

SonarDescription sonar() {
  SonarDescription sonar;
  sonar.receivers = 1;
  sonar.stop_and_hop = true;
  sonar.near_range = 20;
  sonar.far_range = 40;
  return sonar;
}

/// Speckle heard from `count` places on `length` metres of a slightly uneven track; receivers apart from the transmitter and under way where asked for.
EchoLines speckleLines(int count, double length, bool bistatic) {
  std::vector<EchoPath> paths(static_cast<std::size_t>(count));
  Random random(1);
  for (int i = 0; i < count; ++i) {
    EchoPath& path = paths[static_cast<std::size_t>(i)];
    path.transmitter = path.receiver = {length / count * (i - count / 2), 0.01 * random.gaussian(), 10};
    if (bistatic) {
      path.receiver.x() += 0.3;
      path.receiver_velocity.x() = 2;
    }
  }
  SpeckleOptions options;
  options.lower = {-2, 24, 0};
  options.upper = {2, 34, 0};
  options.density = 10;
  return compressRange(simulateEchoes(sonar(), paths, speckleScene(options, {}, 1), {}), sonar(), {});
}

ImageGrid patch(int rows, int columns, double along_step) {
  ImageGrid grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.range_step = 0.01;
  grid.along_step = along_step;
  grid.origin = {-0.5 * columns * grid.along_step, 24, 0};
  return grid;
}

/// What one would write first: double, linear interpolation, the library's square root, sine and cosine.
Image plainLoop(const EchoLines& lines, const ImageGrid& grid) {
  Image image{grid, std::vector<std::complex<float>>(grid.pixels())};
  const double wave = 2 * kPi * lines.carrier / lines.sound_speed;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector3d point = grid.point(row, column);
      double real = 0, imaginary = 0;
      for (std::size_t i = 0; i < lines.paths.size(); ++i) {
        const double length = 2 * (point - lines.paths[i].transmitter).norm(), position = lines.position(length), floor = std::floor(position);
        const std::complex<float>* const at = lines.line(i) + static_cast<int>(floor);
        const double weight = position - floor, c = std::cos(wave * length), s = std::sin(wave * length);
        const double re = at[0].real() + weight * (at[1].real() - at[0].real()), im = at[0].imag() + weight * (at[1].imag() - at[0].imag());
        real += re * c - im * s;
        imaginary += re * s + im * c;
      }
      image.at(row, column) = {static_cast<float>(real), static_cast<float>(imaginary)};
    }
  return image;
}

/// Best of the repeats, in 10^6 pulses times pixels a second.
struct Rate {
  double wall = 0;
  double cpu = 0;  ///< of CPU time, which other programs on the machine disturb less
};

template <class Make>
Rate rate(const EchoLines& lines, const ImageGrid& grid, int repeats, Make&& make) {
  Rate best;
  const double work = 1e-6 * static_cast<double>(lines.paths.size()) * static_cast<double>(grid.pixels());
  for (int i = 0; i < repeats; ++i) {
    const std::clock_t cpu_start = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const Image image = make();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    if (!std::isfinite(image.pixels.front().real())) std::abort();
    best.wall = std::max(best.wall, work / seconds);
    best.cpu = std::max(best.cpu, work / cpu_seconds);
  }
  return best;
}

constexpr double kBeam = 4.5;  // what 0.1 m elements open at 30 m [m]

void compareTargets(int repeats) {
  const ImageGrid grid = patch(1024, 128, 0.025), small = patch(64, 64, 0.025);
  fmt::print("1024 x 128 pixels of 1 x 2.5 cm, 256 lines on {} m; best of {} repeats; 10^6 pulses x pixels; error against double\n", kBeam, repeats);
  const EchoLines few = speckleLines(8, kBeam, false);
  const Rate plain = rate(few, grid, repeats, [&] { return plainLoop(few, grid); });
  fmt::print("{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second\n", "plain double", "monostatic", plain.wall, plain.cpu);
  for (const bool bistatic : {false, true}) {
    const EchoLines lines = speckleLines(256, kBeam, bistatic);
    const Image reference = backprojectReference(lines, small, 2);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      BackprojectionOptions one, two;
      two.threads = 2;
      const Rate alone = rate(lines, grid, repeats, [&] { return backproject(lines, grid, one); });
      const Rate both = rate(lines, grid, repeats, [&] { return backproject(lines, grid, two); });
      fmt::print("{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second; two threads {:5.0f} a second: x {:.2f}, {:5.0f} a CPU second; {:.1f} dB\n",
                 backprojectionTarget(), bistatic ? "bistatic" : "monostatic", alone.wall, alone.cpu, both.wall, both.wall / alone.wall, both.cpu,
                 relativeError(backproject(lines, small, {}), reference));
      std::fflush(stdout);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}

/// n lines on the same aperture, n x n pixels of the same size, one thread, in CPU time.
void compareFactorized() {
  double last_direct = 0, last_factorized = 0;
  for (const int n : {128, 256, 512}) {
    const EchoLines lines = speckleLines(n, kBeam, false);
    const ImageGrid grid = patch(n, n, 0.025);
    Image direct, factorized;
    const double work = 1e-6 * static_cast<double>(n) * static_cast<double>(grid.pixels());
    const double direct_seconds = work / rate(lines, grid, 2, [&] { return direct = backproject(lines, grid, {}); }).cpu;
    const double factorized_seconds = work / rate(lines, grid, 2, [&] { return factorized = backprojectFactorized(lines, grid, 1); }).cpu;
    fmt::print("n {:4}: direct {:.3f} s, factorised {:.3f} s, error {:.1f} dB", n, direct_seconds, factorized_seconds, relativeError(factorized, direct));
    if (last_direct > 0) fmt::print("; times {:.1f} and {:.1f} for twice n", direct_seconds / last_direct, factorized_seconds / last_factorized);
    fmt::print("\n");
    std::fflush(stdout);
    last_direct = direct_seconds;
    last_factorized = factorized_seconds;
  }
}

}  // namespace

int main(int argc, char** argv) {
  compareTargets(argc > 1 ? std::atoi(argv[1]) : 20);
  compareFactorized();
}
