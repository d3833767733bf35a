// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pulses times pixels a second: backproject() on one and two threads beside a plain loop in double, all in one run. Each figure is the best of several short
// repeats, because the cores may be shared. usage: backprojection_speed [REPEATS]
#include <fmt/format.h>
#include <hwy/targets.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/random.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;

/// The 4.5 m that a beam of 0.1 m elements opens at 30 m, with noise for echoes; receivers apart from the transmitter and under way where asked for.
EchoLines noiseLines(int count, bool bistatic) {
  EchoLines lines;
  lines.carrier = 100e3;
  lines.sound_speed = 1500;
  lines.sample_rate = 60e3;
  lines.first_delay = 2 * 20 / lines.sound_speed;
  lines.samples = 1600;
  lines.data.resize(static_cast<std::size_t>(count) * static_cast<std::size_t>(lines.samples));
  Random random(1);
  for (auto& value : lines.data) value = {static_cast<float>(random.gaussian()), static_cast<float>(random.gaussian())};
  for (int i = 0; i < count; ++i) {
    EchoPath path;
    path.transmitter = path.receiver = {4.5 / count * (i - count / 2), 0.01 * random.gaussian(), 10};
    if (bistatic) {
      path.receiver.x() += 0.3;
      path.receiver_velocity.x() = 2;
    }
    lines.paths.push_back(path);
  }
  return lines;
}

ImageGrid patch(int rows, int columns) {
  ImageGrid grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.range_step = 0.01;
  grid.along_step = 0.025;
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

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 20;
  const ImageGrid grid = patch(1024, 128);
  fmt::print("1024 x 128 pixels of 1 x 2.5 cm, 256 lines; best of {} repeats; 10^6 pulses x pixels\n", repeats);
  const EchoLines few = noiseLines(8, false);
  const Rate plain = rate(few, grid, repeats, [&] { return plainLoop(few, grid); });
  fmt::print("{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second\n", "plain double", "monostatic", plain.wall, plain.cpu);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (const bool bistatic : {false, true}) {
      const EchoLines lines = noiseLines(256, bistatic);
      BackprojectionOptions one, two;
      two.threads = 2;
      const Rate alone = rate(lines, grid, repeats, [&] { return backproject(lines, grid, one); });
      const Rate both = rate(lines, grid, repeats, [&] { return backproject(lines, grid, two); });
      fmt::print("{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second; two threads {:5.0f} a second: x {:.2f}\n", backprojectionTarget(),
                 bistatic ? "bistatic" : "monostatic", alone.wall, alone.cpu, both.wall, both.wall / alone.wall);
    }
  }
}
