// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <vector>

namespace sas_motion::imaging {

struct Scatterer {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  std::complex<double> amplitude = 1;
};

/// An upright block that throws a shadow, in the axes of the local frame.
struct Block {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(), upper = Eigen::Vector3d::Zero();  ///< opposite corners [m]

  /// Whether it stands between the two points.
  bool hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

struct Scene {
  std::vector<Scatterer> scatterers;
  std::vector<Block> blocks;
};

/// A flat patch of bottom with speckle, and blocks on it.
struct SpeckleOptions {
  Eigen::Vector3d lower = Eigen::Vector3d::Zero(),
                  upper =
                      Eigen::Vector3d::Zero();  ///< opposite corners of the bottom; z of `lower` is the bottom's [m]
  double density = 3000;                        ///< scatterers a square metre
  double block_contrast = 10;                   ///< power of a block's faces over the bottom's, an area
};

/// Scatterers at random places with circular Gaussian amplitudes, whose power an area is 1; blocks get scatterers on
/// their sides and top.
Scene speckleScene(const SpeckleOptions& options, const std::vector<Block>& blocks, std::uint64_t seed);

}  // namespace sas_motion::imaging
