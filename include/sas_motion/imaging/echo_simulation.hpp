// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"

namespace sas_motion::imaging {

struct Scatterer {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  std::complex<double> amplitude = 1;
};

/// An upright block that throws a shadow, in the axes of the local frame.
struct Block {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();  ///< opposite corners [m]

  /// Whether the block stands between the two points.
  bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

struct Scene {
  std::vector<Scatterer> scatterers;
  std::vector<Block> blocks;
};

/// A flat patch of bottom with speckle.
struct SpeckleOptions {
  /// Opposite corners; z of `lower` is the height of the bottom [m].
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();
  double density = 3000;       ///< of scatterers [1/m^2]
  double block_contrast = 10;  ///< power an area of a block's faces over that of the bottom [-]
};

/// Scatterers at random places on the bottom and on the blocks' sides and tops. Their amplitudes are circular Gaussian,
/// and their power an area is 1.
Scene speckleScene(const SpeckleOptions& options, const std::vector<Block>& blocks, std::uint64_t seed);

struct EchoOptions {
  std::vector<double> slant_errors;  ///< one-way range error added to each line [m]; empty: none
  double noise = 0;                  ///< standard deviation of a sample's complex white noise
  std::uint64_t seed = 0;            ///< of the noise
  int threads = 1;
};

/// The raw echoes of a scene: chirps at their two-way delays, weighted by the beam and hidden by blocks, without
/// spreading loss, as after time-varied gain. A line begins at the near range and is a pulse longer than the swath.
/// Gives the same bits for any number of threads. Throws std::invalid_argument unless slant_errors are one a line.
EchoLines simulateEchoes(const SonarDescription& sonar, const std::vector<EchoPath>& paths, const Scene& scene,
                         const EchoOptions& options);

}  // namespace sas_motion::imaging
