// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imaging/polar_image.hpp"
#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/interpolator.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

constexpr std::size_t kFewLines = 4;  // summed line by line
constexpr std::size_t kChildren = 4;
constexpr double kOversampling = 2;          // of polar images, both ways
constexpr int kMarginPerLevel = 6;           // range samples: a parent's margin and the taps beyond it
constexpr double kLargestCosineStep = 0.03;  // keeps the taps beyond the grid well away from the track's direction

class Factorization {
 public:
  Factorization(const EchoLines& lines, const ImageGrid& grid, int threads)
      : lines_(lines), grid_(grid), threads_(threads) {}

  Image run() const {
    const std::vector<PolarImage> parts = children(0, lines_.paths.size(), 1, threads_);
    Image image{grid_, std::vector<std::complex<float>>(grid_.pixels())};
    forEachTask(static_cast<std::size_t>(grid_.rows), threads_, [&](std::size_t row) {
      for (int column = 0; column < grid_.columns; ++column)
        image.at(static_cast<int>(row), column) = merged(parts, grid_.point(static_cast<double>(row), column), 0);
    });
    return image;
  }

 private:
  /// The images of up to kChildren equal parts of an aperture.
  std::vector<PolarImage> children(std::size_t first, std::size_t last, int level, int threads) const {
    const std::size_t count = std::min(kChildren, last - first);
    std::vector<PolarImage> parts(count, PolarImage(grid_, grid_.origin, 1, 1, 0));
    forEachTask(count, threads, [&](std::size_t i) {
      parts[i] = aperture(first + (last - first) * i / count, first + (last - first) * (i + 1) / count, level);
    });
    return parts;
  }

  /// The image of the lines first ... last - 1.
  PolarImage aperture(std::size_t first, std::size_t last, int level) const {
    PolarImage image = empty(first, last, level);
    const bool few = last - first <= kFewLines;
    const std::vector<PolarImage> parts = few ? std::vector<PolarImage>() : children(first, last, level + 1, 1);
    for (int cosine = 0; cosine < image.cosines(); ++cosine)
      for (int range = 0; range < image.ranges(); ++range) {
        const PolarPoint polar = image.sample(range, cosine);
        Eigen::Vector3d point;
        if (image.place(polar, point))
          image.at(range, cosine) = few ? summed(first, last, point, polar.range) : merged(parts, point, polar.range);
      }
    return image;
  }

  /// An image whose steps sample the bands of range and cosine; an aperture of length A turns 2 A / lambda cycles over
  /// a unit of cosine.
  PolarImage empty(std::size_t first, std::size_t last, int level) const {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (std::size_t i = first; i < last; ++i) centre += phaseCentre(i) / static_cast<double>(last - first);
    double half_length = 0;
    for (std::size_t i = first; i < last; ++i) half_length = std::max(half_length, (phaseCentre(i) - centre).norm());
    const double shortest_wave = lines_.sound_speed / (lines_.carrier + lines_.sample_rate / 2),
                 range_step = lines_.sound_speed / (2 * lines_.sample_rate) * 1.5 / kOversampling;
    const double cosine_step = std::min(kLargestCosineStep, shortest_wave / (4 * half_length) / kOversampling);
    return {grid_, centre, range_step, cosine_step, kMarginPerLevel * level};
  }

  std::complex<float> summed(std::size_t first, std::size_t last, const Eigen::Vector3d& point, double range) const {
    std::complex<double> sum = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double length = pathLength(lines_.paths[i], point, lines_.sound_speed);
      sum += interpolator_.at(lines_.line(i), lines_.samples, lines_.position(length)) * carrier(length - 2 * range);
    }
    return std::complex<float>(sum);
  }

  std::complex<float> merged(const std::vector<PolarImage>& parts, const Eigen::Vector3d& point, double range) const {
    std::complex<double> sum = 0;
    for (const auto& part : parts) {
      const PolarPoint polar = part.seen(point);
      sum += std::complex<double>(part.between(polar)) * carrier(2 * (polar.range - range));
    }
    return std::complex<float>(sum);
  }

  std::complex<double> carrier(double length) const {
    return std::polar(1.0, 2 * kPi * lines_.carrier / lines_.sound_speed * length);
  }

  /// Between the transmitter and where the receiver is when the echo from the grid's middle arrives.
  Eigen::Vector3d phaseCentre(std::size_t i) const {
    const EchoPath& path = lines_.paths[i];
    const double length = pathLength(path, grid_.point(0.5 * grid_.rows, 0.5 * grid_.columns), lines_.sound_speed);
    return (path.transmitter + path.receiver + length / lines_.sound_speed * path.receiver_velocity) / 2;
  }

  const EchoLines& lines_;
  ImageGrid grid_;
  int threads_;
  Interpolator interpolator_;
};

/// A range and an angle mean one pixel only where the nearest row lies before every sonar.
void checkSides(const EchoLines& lines, const ImageGrid& grid) {
  for (const auto& path : lines.paths)
    if (!((grid.origin - path.transmitter).dot(grid.range_axis) > 0))
      throw std::invalid_argument(
          "backprojectFactorized: the grid reaches below or behind the sonar; begin it further away");
}

}  // namespace

Image backprojectFactorized(const EchoLines& lines, const ImageGrid& grid, int threads) {
  checkGrid(grid);
  checkSides(lines, grid);
  return Factorization(lines, grid, threads).run();
}

}  // namespace sas_motion::imaging
