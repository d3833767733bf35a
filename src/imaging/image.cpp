// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/image.hpp"

#include <cmath>
#include <stdexcept>

namespace sas_motion::imaging {

void checkGrid(const ImageGrid& grid) {
  constexpr double kTolerance = 1e-9;
  const bool orthonormal = std::abs(grid.range_axis.squaredNorm() - 1) < kTolerance &&
                           std::abs(grid.along_axis.squaredNorm() - 1) < kTolerance &&
                           std::abs(grid.range_axis.dot(grid.along_axis)) < kTolerance;
  if (!orthonormal) throw std::invalid_argument("ImageGrid: the axes must be unit vectors at right angles");
  if (!(grid.range_step > 0) || !(grid.along_step > 0))
    throw std::invalid_argument("ImageGrid: the steps must be above 0");
  if (grid.rows < 1 || grid.columns < 1)
    throw std::invalid_argument("ImageGrid: there must be at least one row and one column");
}

double relativeError(const Image& image, const Image& reference) {
  double error = 0, energy = 0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    error += std::norm(std::complex<double>(image.pixels[i]) - std::complex<double>(reference.pixels[i]));
    energy += std::norm(std::complex<double>(reference.pixels[i]));
  }
  return 10 * std::log10(error / energy);
}

}  // namespace sas_motion::imaging
