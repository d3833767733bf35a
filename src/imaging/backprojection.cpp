// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/backprojection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imaging/fine_lines.hpp"

namespace sas_motion::imaging {
namespace {

constexpr double kLargestTile = 2;  // side of a tile [m]: float then resolves its paths to 1e-7 m
constexpr int kMostRows = 32, kMostColumns = 2 * kTileLanes;

/// A tile's place in the image.
struct Patch {
  int row, column, rows, columns;
};

class Tiling {
 public:
  explicit Tiling(const ImageGrid& grid)
      : grid_(grid),
        rows_(std::clamp(static_cast<int>(kLargestTile / grid.range_step), 1, kMostRows)),
        columns_(2 * grid.along_step * kTileLanes > kLargestTile ? kTileLanes : kMostColumns),
        across_((grid.columns + columns_ - 1) / columns_),
        down_((grid.rows + rows_ - 1) / rows_) {}

  std::size_t count() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
  Patch patch(std::size_t i) const {
    const int row = static_cast<int>(i) / across_ * rows_, column = static_cast<int>(i) % across_ * columns_;
    return {row, column, std::min(rows_, grid_.rows - row), std::min(columns_, grid_.columns - column)};
  }
  int columns() const { return columns_; }
  /// From a tile's centre to its furthest pixel, including columns beyond the image's edge that fill its vectors [m].
  double radius() const { return std::hypot(0.5 * rows_ * grid_.range_step, columns_ * grid_.along_step); }
  Eigen::Vector3d centre(const Patch& patch) const {
    return grid_.point(patch.row + 0.5 * (patch.rows - 1), patch.column + 0.5 * (patch.columns - 1));
  }
  Tile tile(const Patch& patch, double cycles_per_metre, double samples_per_metre) const {
    return {patch.rows,
            columns_,
            static_cast<float>(-0.5 * (patch.rows - 1) * grid_.range_step),
            static_cast<float>(-0.5 * (patch.columns - 1) * grid_.along_step),
            static_cast<float>(grid_.range_step),
            static_cast<float>(grid_.along_step),
            static_cast<float>(cycles_per_metre),
            static_cast<float>(samples_per_metre)};
  }

 private:
  ImageGrid grid_;
  int rows_, columns_, across_, down_;
};

TileLeg tileLeg(const Eigen::Vector3d& antenna, const Eigen::Vector3d& centre, const ImageGrid& grid) {
  const Eigen::Vector3d way = centre - antenna;
  return {static_cast<float>(2 * way.dot(grid.range_axis)), static_cast<float>(2 * way.dot(grid.along_axis)),
          static_cast<float>(way.norm()), static_cast<float>(way.squaredNorm())};
}

/// Places the receiver where it is when the centre's echo arrives. A pixel's echo arrives dL / c later; to first order
/// in the receiver's speed over c, its motion shrinks dL by 1 / (1 + w), w being its speed towards the pixel over c.
void setGeometry(TileLine& line, const EchoPath& path, const Eigen::Vector3d& centre, double path_length,
                 double sound_speed, const ImageGrid& grid) {
  const Eigen::Vector3d mach = path.receiver_velocity / sound_speed, receiver = path.receiver + mach * path_length;
  line.legs[0] = tileLeg(path.transmitter, centre, grid);
  line.legs[1] = tileLeg(receiver, centre, grid);
  const double range = (centre - receiver).norm();
  const Eigen::Vector3d sight = (centre - receiver) / range, gradient = (mach - sight * sight.dot(mach)) / range;
  const double slower = 1 / (1 + sight.dot(mach));
  line.doppler = static_cast<float>(slower);
  line.doppler_range = static_cast<float>(-slower * slower * gradient.dot(grid.range_axis));
  line.doppler_track = static_cast<float>(-slower * slower * gradient.dot(grid.along_axis));
}

bool illuminates(const EchoPath& path, const Eigen::Vector3d& centre, double half_angle) {
  return half_angle > kPi / 2 ||
         std::abs(path.forward.dot((centre - path.transmitter).normalized())) <= std::sin(half_angle);
}

class Backprojector {
 public:
  Backprojector(const EchoLines& lines, const ImageGrid& grid, const BackprojectionOptions& options)
      : lines_(lines),
        options_(options),
        tiling_(grid),
        fine_(lines, 2 * tiling_.radius()),
        image_{grid, std::vector<std::complex<float>>(grid.pixels())} {
    monostatic_ =
        std::all_of(lines.paths.begin(), lines.paths.end(), [](const EchoPath& path) { return path.monostatic(); });
  }

  Image run() {
    for (std::size_t first = 0; first < lines_.paths.size(); first += kBatch) {
      fine_.load(first, options_.threads);
      const std::size_t last = std::min(first + kBatch, lines_.paths.size());
      forEachTask(tiling_.count(), options_.threads, [&](std::size_t i) { addToTile(tiling_.patch(i), first, last); });
    }
    return std::move(image_);
  }

 private:
  void addToTile(const Patch& patch, std::size_t first, std::size_t last) {
    const Eigen::Vector3d centre = tiling_.centre(patch);
    TileLine tile_lines[kBatch];
    int count = 0;
    for (std::size_t i = first; i < last; ++i) {
      const EchoPath& path = lines_.paths[i];
      const double length = pathLength(path, centre, lines_.sound_speed);
      TileLine& line = tile_lines[count];
      if (!std::isfinite(length) || !illuminates(path, centre, options_.half_angle) || !fine_.aim(i, length, line))
        continue;
      setGeometry(line, path, centre, length, lines_.sound_speed, image_.grid);
      const double turns = lines_.carrier / lines_.sound_speed * length;
      line.turns = static_cast<float>(turns - std::round(turns));
      ++count;
    }
    const double cycles_per_metre = lines_.carrier / lines_.sound_speed,
                 samples_per_metre = lines_.sample_rate * FineLines::kFactor / lines_.sound_speed;
    float real[kMostRows * kMostColumns] = {}, imaginary[kMostRows * kMostColumns] = {};
    accumulateTile(tiling_.tile(patch, cycles_per_metre, samples_per_metre), tile_lines, count, monostatic_, real,
                   imaginary);
    for (int row = 0; row < patch.rows; ++row)
      for (int column = 0; column < patch.columns; ++column)
        image_.at(patch.row + row, patch.column + column) +=
            std::complex<float>(real[row * tiling_.columns() + column], imaginary[row * tiling_.columns() + column]);
  }

  const EchoLines& lines_;
  BackprojectionOptions options_;
  Tiling tiling_;
  FineLines fine_;
  Image image_;
  bool monostatic_ = false;
};

}  // namespace

Image backproject(const EchoLines& lines, const ImageGrid& grid, const BackprojectionOptions& options) {
  checkGrid(grid);
  const double needed = static_cast<double>(grid.pixels()) * sizeof(std::complex<float>) +
                        FineLines::bytes(lines, 2 * Tiling(grid).radius());
  if (needed > options.memory_limit)
    throw std::invalid_argument(
        fmt::format("backproject: an image of {} x {} pixels needs {:.0f} MB but may have {:.0f} MB; make the grid "
                    "smaller or raise memory_limit",
                    grid.rows, grid.columns, needed / 1e6, options.memory_limit / 1e6));
  return Backprojector(lines, grid, options).run();
}

Image backprojectReference(const EchoLines& lines, const ImageGrid& grid, int threads) {
  checkGrid(grid);
  Image image{grid, std::vector<std::complex<float>>(grid.pixels())};
  const Interpolator interpolator;
  forEachTask(static_cast<std::size_t>(grid.rows), threads, [&](std::size_t row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector3d point = grid.point(static_cast<double>(row), column);
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < lines.paths.size(); ++i) {
        const double length = pathLength(lines.paths[i], point, lines.sound_speed);
        sum += interpolator.at(lines.line(i), lines.samples, lines.position(length)) *
               std::polar(1.0, 2 * kPi * lines.carrier / lines.sound_speed * length);
      }
      image.at(static_cast<int>(row), column) = std::complex<float>(sum);
    }
  });
  return image;
}

std::string backprojectionTarget() { return kernelTarget(); }

}  // namespace sas_motion::imaging
