// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What tests of imaging share: a small sonar, tracks, targets.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/random.hpp"

namespace sas_motion::imaging::testing {

/// One element, a swath of a few metres, and little else to compute.
inline SonarDescription smallSonar() {
  SonarDescription sonar;
  sonar.receivers = 1;
  sonar.pulse_length = 2e-3;
  sonar.near_range = 26;
  sonar.far_range = 36;
  sonar.stop_and_hop = true;
  return sonar;
}

/// Pings `spacing` apart along x, centred on x = 0, 10 m over the bottom, with a sway of this amplitude and 1.7 m
/// period.
inline std::vector<PingPose> track(int pings, double spacing, double sway = 0) {
  std::vector<PingPose> poses(static_cast<std::size_t>(pings));
  for (int i = 0; i < pings; ++i) {
    const double x = (i - 0.5 * (pings - 1)) * spacing;
    poses[static_cast<std::size_t>(i)].position = {x, sway * std::sin(2 * kPi * x / 1.7),
                                                   10 + 0.7 * sway * std::cos(2 * kPi * x / 2.3)};
    poses[static_cast<std::size_t>(i)].velocity = {2, 0, 0};
  }
  return poses;
}

inline Scene points(const std::vector<Eigen::Vector3d>& places) {
  Scene scene;
  for (const auto& place : places) scene.scatterers.push_back({place, 1});
  return scene;
}

inline EchoLines compressedEchoes(const SonarDescription& sonar, const std::vector<EchoPath>& paths, const Scene& scene,
                                  const EchoOptions& options = {}, RangeFilter filter = RangeFilter::Equalized) {
  CompressionOptions compression;
  compression.filter = filter;
  compression.threads = 2;
  EchoOptions two_threads = options;
  two_threads.threads = 2;
  return compressRange(simulateEchoes(sonar, paths, scene, two_threads), sonar, compression);
}

/// Pixels around a place on the bottom.
inline ImageGrid gridAround(const Eigen::Vector3d& place, int rows, int columns, double range_step = 0.008,
                            double along_step = 0.02) {
  ImageGrid grid;
  grid.rows = rows;
  grid.columns = columns;
  grid.range_step = range_step;
  grid.along_step = along_step;
  grid.origin = place - Eigen::Vector3d(0.5 * columns * along_step, 0.5 * rows * range_step, 0);
  return grid;
}

}  // namespace sas_motion::imaging::testing
