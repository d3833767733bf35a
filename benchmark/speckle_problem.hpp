// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Speckle on a flat bottom, heard from an almost straight track, and how fast it is focused: what the measurements of
// backprojection share.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "parallel/instruction_sets.hpp"
#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/math/random.hpp"

namespace sas_motion::benchmark {

using namespace imaging;

constexpr double kBeam = 4.5;  // what 0.1 m elements open at 30 m [m]

inline SonarDescription sonar() {
  SonarDescription sonar;
  sonar.receivers = 1;
  sonar.stop_and_hop = true;
  sonar.near_range = 20;
  sonar.far_range = 40;
  return sonar;
}

/// Speckle heard from `count` places on kBeam metres of a slightly uneven track; receivers apart from the transmitter
/// and under way where asked for.
inline EchoLines speckleLines(int count, bool bistatic) {
  std::vector<EchoPath> paths(static_cast<std::size_t>(count));
  Random random(1);
  for (int i = 0; i < count; ++i) {
    EchoPath& path = paths[static_cast<std::size_t>(i)];
    path.transmitter = path.receiver = {kBeam / count * (i - count / 2), 0.01 * random.gaussian(), 10};
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

/// Pixels of 1 x 2.5 cm on the bottom, abeam of the middle of the track.
inline ImageGrid patch(int rows, int columns) {
  ImageGrid grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.range_step = 0.01;
  grid.along_step = 0.025;
  grid.origin = {-0.5 * columns * grid.along_step, 24, 0};
  return grid;
}

/// In 10^6 pulses times pixels a second.
struct Rate {
  double wall = 0;
  double cpu = 0;  ///< of CPU time, which other programs on the machine disturb less

  /// The better of both, each by itself.
  Rate best(const Rate& other) const { return {std::max(wall, other.wall), std::max(cpu, other.cpu)}; }
};

/// Of making the image once.
template <class Make>
Rate rateOnce(const EchoLines& lines, Make&& make) {
  const std::clock_t cpu_start = std::clock();
  const auto start = std::chrono::steady_clock::now();
  const Image image = make();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  if (!std::isfinite(image.pixels.front().real())) std::abort();
  const double work = 1e-6 * static_cast<double>(lines.paths.size()) * static_cast<double>(image.grid.pixels());
  return {work / seconds, work / cpu_seconds};
}

/// The best of the repeats.
template <class Make>
Rate rate(const EchoLines& lines, int repeats, Make&& make) {
  Rate found;
  for (int i = 0; i < repeats; ++i) found = found.best(rateOnce(lines, make));
  return found;
}

}  // namespace sas_motion::benchmark
