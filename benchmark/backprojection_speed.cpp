// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pulses times pixels a second: backproject() on one and two threads beside a plain loop in double, all in one run.
// Each figure is the best of several short repeats, because the cores may be shared. usage: backprojection_speed
// [REPEATS]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/math/angles.hpp"
#include "speckle_problem.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::benchmark;

/// What one would write first: double, linear interpolation, the library's square root, sine and cosine.
Image plainLoop(const EchoLines& lines, const ImageGrid& grid) {
  Image image{grid, std::vector<std::complex<float>>(grid.pixels())};
  const double wave = 2 * kPi * lines.carrier / lines.sound_speed;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector3d point = grid.point(row, column);
      double real = 0, imaginary = 0;
      for (std::size_t i = 0; i < lines.paths.size(); ++i) {
        const double length = 2 * (point - lines.paths[i].transmitter).norm(), position = lines.position(length),
                     floor = std::floor(position);
        const std::complex<float>* const at = lines.line(i) + static_cast<int>(floor);
        const double weight = position - floor, c = std::cos(wave * length), s = std::sin(wave * length);
        const double re = at[0].real() + weight * (at[1].real() - at[0].real()),
                     im = at[0].imag() + weight * (at[1].imag() - at[0].imag());
        real += re * c - im * s;
        imaginary += re * s + im * c;
      }
      image.at(row, column) = {static_cast<float>(real), static_cast<float>(imaginary)};
    }
  return image;
}

/// One and two threads in turns, so that both meet the same neighbours on the machine.
struct Scaling {
  Rate one, two;           ///< the best of each
  double median_gain = 0;  ///< of the pairs, by wall time
};

Scaling scaling(const EchoLines& lines, const ImageGrid& grid, int repeats) {
  Scaling result;
  BackprojectionOptions one, two;
  two.threads = 2;
  std::vector<double> gains;
  for (int i = 0; i < repeats; ++i) {
    const Rate alone = rateOnce(lines, [&] { return backproject(lines, grid, one); });
    const Rate both = rateOnce(lines, [&] { return backproject(lines, grid, two); });
    result.one = result.one.best(alone);
    result.two = result.two.best(both);
    gains.push_back(both.wall / alone.wall);
  }
  std::nth_element(gains.begin(), gains.begin() + repeats / 2, gains.end());
  result.median_gain = gains[static_cast<std::size_t>(repeats / 2)];
  return result;
}

void compareTargets(int repeats) {
  const ImageGrid grid = patch(1024, 128), small = patch(64, 64);
  fmt::print(
      "1024 x 128 pixels of 1 x 2.5 cm, 256 lines on {} m; best of {} repeats, one and two threads in turns; 10^6 "
      "pulses x pixels; error against double\n",
      kBeam, repeats);
  const EchoLines few = speckleLines(8, false);
  const Rate plain = rate(few, repeats, [&] { return plainLoop(few, grid); });
  fmt::print("{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second\n", "plain double", "monostatic", plain.wall,
             plain.cpu);
  for (const bool bistatic : {false, true}) {
    const EchoLines lines = speckleLines(256, bistatic);
    const Image reference = backprojectReference(lines, small, 2);
    forEachInstructionSet([&] {
      const Scaling found = scaling(lines, grid, repeats);
      fmt::print(
          "{:14} {:10} {:5.0f} a second, {:5.0f} a CPU second; two threads {:5.0f} a second, x {:.2f} best of each, x "
          "{:.2f} median of pairs, "
          "{:5.0f} a CPU second; {:.1f} dB\n",
          backprojectionTarget(), bistatic ? "bistatic" : "monostatic", found.one.wall, found.one.cpu, found.two.wall,
          found.two.wall / found.one.wall, found.median_gain, found.two.cpu,
          relativeError(backproject(lines, small, {}), reference));
      std::fflush(stdout);
    });
  }
}

/// n lines on the same aperture, n x n pixels of the same size, one thread, in CPU time.
void compareFactorized() {
  double last_direct = 0, last_factorized = 0;
  for (const int n : {128, 256, 512}) {
    const EchoLines lines = speckleLines(n, false);
    const ImageGrid grid = patch(n, n);
    Image direct, factorized;
    const double work = 1e-6 * static_cast<double>(n) * static_cast<double>(grid.pixels());
    const double direct_seconds = work / rate(lines, 2, [&] { return direct = backproject(lines, grid, {}); }).cpu;
    const double factorized_seconds =
        work / rate(lines, 2, [&] { return factorized = backprojectFactorized(lines, grid, 1); }).cpu;
    fmt::print("n {:4}: direct {:.3f} s, factorised {:.3f} s, error {:.1f} dB", n, direct_seconds, factorized_seconds,
               relativeError(factorized, direct));
    if (last_direct > 0)
      fmt::print("; times {:.1f} and {:.1f} for twice n", direct_seconds / last_direct,
                 factorized_seconds / last_factorized);
    fmt::print("\n");
    std::fflush(stdout);
    last_direct = direct_seconds;
    last_factorized = factorized_seconds;
  }
}

}  // namespace

int main(int argc, char** argv) {
  compareTargets(argc > 1 ? std::max(1, std::atoi(argv[1])) : 20);
  compareFactorized();
}
