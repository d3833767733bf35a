// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// A plane of pixels in the local frame: rows along range, columns along track.
struct ImageGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       ///< of pixel (0, 0) [m]
  Eigen::Vector3d range_axis = Eigen::Vector3d::UnitY();  ///< unit vector towards growing row
  Eigen::Vector3d along_axis = Eigen::Vector3d::UnitX();  ///< unit vector towards growing column
  double range_step = 0.01;                               ///< between rows [m]
  double along_step = 0.02;                               ///< between columns [m]
  int rows = 0, columns = 0;

  Eigen::Vector3d point(double row, double column) const {
    return origin + row * range_step * range_axis + column * along_step * along_axis;
  }
  std::size_t pixels() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
};

/// Throws std::invalid_argument where the axes are not orthonormal, a step is not positive or there is no pixel.
void checkGrid(const ImageGrid& grid);

/// A complex image with its carrier: a scatterer at p0 appears as exp(+j 2 pi f0 (L(p) - L(p0)) / c) times its
/// envelope.
struct Image {
  ImageGrid grid;
  std::vector<std::complex<float>> pixels;  ///< row by row

  const std::complex<float>& at(int row, int column) const { return pixels[index(row, column)]; }
  std::complex<float>& at(int row, int column) { return pixels[index(row, column)]; }
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) + static_cast<std::size_t>(column);
  }
};

/// Energy of the difference over the energy of the reference [dB].
double relativeError(const Image& image, const Image& reference);

/// Writes STEM.npy, a NumPy array of complex64, rows x columns, and STEM.json with the members of the grid. Each file
/// is whole or not there. Throws std::runtime_error naming the file.
void writeImage(const std::string& stem, const Image& image);

}  // namespace sas_motion::imaging
