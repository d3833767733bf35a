// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace sas_motion::imaging {

/// A plane of pixels in the local frame: rows along range, columns along track.
struct ImageGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       ///< of pixel (0, 0) [m]
  Eigen::Vector3d range_axis = Eigen::Vector3d::UnitY();  ///< direction of growing row, a unit vector
  Eigen::Vector3d along_axis =
      Eigen::Vector3d::UnitX();  ///< direction of growing column, a unit vector at right angles to range_axis
  double range_step = 0.01;      ///< between rows [m]
  double along_step = 0.02;      ///< between columns [m]
  int rows = 0, columns = 0;

  Eigen::Vector3d point(double row, double column) const {
    return origin + row * range_step * range_axis + column * along_step * along_axis;
  }
  std::size_t pixels() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
};

/// Throws std::invalid_argument where the axes are not orthonormal, a step is not positive or there is no pixel.
void checkGrid(const ImageGrid& grid);

/// A complex image. It holds the carrier: a scatterer at p0 looks like exp(+j 2 pi f0 (L(p) - L(p0)) / c) times its
/// envelope.
struct Image {
  ImageGrid grid;
  std::vector<std::complex<float>> pixels;  ///< row by row

  const std::complex<float>& at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                  static_cast<std::size_t>(column)];
  }
  std::complex<float>& at(int row, int column) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// Energy of the difference over the energy of the reference [dB].
double relativeError(const Image& image, const Image& reference);

}  // namespace sas_motion::imaging
