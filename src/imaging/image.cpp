// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/image.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::imaging {
namespace {

/// Version 1.0 of the format: magic, version, length of the text that follows, and the text, padded so that the data
/// begin at a multiple of 64 bytes.
std::string npyHeader(const ImageGrid& grid) {
  std::string text =
      fmt::format("{{'descr': '<c8', 'fortran_order': False, 'shape': ({}, {}), }}", grid.rows, grid.columns);
  constexpr std::size_t kPrefix = 10;
  text.resize((kPrefix + text.size()) / 64 * 64 + 63 - kPrefix, ' ');
  text += '\n';
  const auto length = static_cast<unsigned>(text.size());
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 0xFF) + static_cast<char>(length >> 8) + text;
}

std::string vectorText(const Eigen::Vector3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

}  // namespace

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

void writeImage(const std::string& stem, const Image& image) {
  const std::string name = stem + ".npy";
  AtomicFile file(name);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << npyHeader(image.grid);
  stream.write(reinterpret_cast<const char*>(image.pixels.data()),
               static_cast<std::streamsize>(image.pixels.size() * sizeof(image.pixels[0])));
  stream.close();
  if (!stream) throw std::runtime_error(fmt::format("{}: could not be written; is the disk full?", name));
  file.commit();
  const ImageGrid& grid = image.grid;
  writeFile(stem + ".json",
            fmt::format("{{\"origin\": {}, \"range_axis\": {}, \"along_axis\": {}, \"range_step\": {:.17g}, "
                        "\"along_step\": {:.17g}, \"rows\": {}, \"columns\": {}}}\n",
                        vectorText(grid.origin), vectorText(grid.range_axis), vectorText(grid.along_axis),
                        grid.range_step, grid.along_step, grid.rows, grid.columns));
}

}  // namespace sas_motion::imaging
