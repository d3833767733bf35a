// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/focus_scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "imaging/fourier.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kMostPixels = 1000000;         // along a side
constexpr double kStepOverResolution = 0.4;  // leaves room for the beam's edges and for an error of heading

/// Unit vector outwards from the track.
Eigen::Vector3d lookDirection(const FocusSettings& settings) { return {0, settings.starboard ? -1.0 : 1.0, 0}; }

double groundRange(const SonarDescription& sonar, double range) {
  return std::sqrt(range * range - sonar.altitude * sonar.altitude);
}

double leastRange(const FocusSettings& settings) {
  const auto nearer = [](const TargetSettings& a, const TargetSettings& b) { return a.range < b.range; };
  return std::min_element(settings.targets.begin(), settings.targets.end(), nearer)->range;
}

/// Resolution along track of an aperture of this length; the beam's first null bounds the aperture that contributes.
double alongResolution(const FocusSettings& settings, double aperture_length) {
  return std::max(settings.sonar.wavelength() * leastRange(settings) / (2 * aperture_length),
                  settings.sonar.element / 4);
}

int pixelCount(const char* key, double length, double step) {
  const double count = std::ceil(length / step) + 1;
  if (count > kMostPixels)
    throw std::invalid_argument(fmt::format("image.{} is {:.3g}, which makes {:.3g} pixels; at most {} are possible",
                                            key, step, count, kMostPixels));
  return static_cast<int>(count);
}

Scene speckle(const FocusSettings& settings, const ImageGrid& grid) {
  const Eigen::Vector3d a = grid.point(0, 0), b = grid.point(grid.rows, grid.columns);
  const SpeckleOptions options{a.cwiseMin(b), a.cwiseMax(b), settings.speckle.density};
  std::vector<Block> blocks;
  if (settings.speckle.block) {
    const Eigen::Vector3d middle = targetPlaces(settings).front() +
                                   Eigen::Vector3d::UnitX() * settings.speckle.block_along +
                                   lookDirection(settings) * settings.speckle.block_range;
    const Eigen::Vector3d size = settings.speckle.block_size, half(size.x() / 2, size.y() / 2, 0);
    blocks.push_back({middle - half, middle + half + Eigen::Vector3d(0, 0, size.z())});
  }
  Scene scene = speckleScene(options, blocks, settings.seed);
  const double amplitude = std::pow(10, settings.speckle.level / 20);
  for (auto& scatterer : scene.scatterers) scatterer.amplitude *= amplitude;
  return scene;
}

}  // namespace

double apertureTime(const FocusSettings& settings, double speed) {
  return settings.targets.front().range * settings.sonar.wavelength() / (settings.sonar.element * speed);
}

std::vector<Eigen::Vector3d> targetPlaces(const FocusSettings& settings) {
  std::vector<Eigen::Vector3d> places;
  for (const auto& target : settings.targets)
    places.emplace_back(Eigen::Vector3d::UnitX() * target.along +
                        lookDirection(settings) * groundRange(settings.sonar, target.range));
  return places;
}

ImageGrid focusGrid(const FocusSettings& settings, double aperture_length, int half_chip) {
  const SonarDescription& sonar = settings.sonar;
  ImageGrid grid;
  grid.range_axis = lookDirection(settings);
  grid.along_axis = Eigen::Vector3d::UnitX();
  const GridSettings& image = settings.image;
  grid.range_step = image.range_step > 0 ? image.range_step : kStepOverResolution * sonar.rangeResolution();
  grid.along_step =
      image.along_step > 0 ? image.along_step : kStepOverResolution * alongResolution(settings, aperture_length);
  constexpr double kSearch = 0.1;  // least radius of the search for a peak [m]
  const double margin_needed = (half_chip + 1) * std::max(grid.range_step, grid.along_step) + kSearch;
  if (image.margin < margin_needed)
    throw std::invalid_argument(fmt::format(
        "image.margin is {} but must be at least {:.3g}, or the side lobes to be measured lie outside the image",
        image.margin, margin_needed));
  Eigen::AlignedBox2d box;  // in range and along
  for (const auto& place : targetPlaces(settings)) box.extend(Eigen::Vector2d(place.dot(grid.range_axis), place.x()));
  const Eigen::Vector2d first = box.min().array() - image.margin, size = box.sizes().array() + 2 * image.margin;
  grid.origin = first.x() * grid.range_axis + first.y() * grid.along_axis;
  grid.rows = pixelCount("range_step", size.x(), grid.range_step);
  // Autofocus transforms along the columns.
  grid.columns = static_cast<int>(fastLength(pixelCount("along_step", size.y(), grid.along_step)));
  return grid;
}

double searchRadius(const FocusSettings& settings, const ImageGrid& grid, int half_chip) {
  double radius = settings.image.margin - (half_chip + 1) * std::max(grid.range_step, grid.along_step);
  const auto places = targetPlaces(settings);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) radius = std::min(radius, (places[i] - places[j]).cwiseAbs().maxCoeff() / 2);
  return radius;
}

Scene focusScene(const FocusSettings& settings, const ImageGrid& grid) {
  Scene scene;
  if (settings.speckle.density > 0) scene = speckle(settings, grid);
  for (const auto& place : targetPlaces(settings)) scene.scatterers.push_back({place, 1});
  return scene;
}

double memoryNeeded(const FocusSettings& settings, const ImageGrid& grid, std::size_t lines) {
  const SonarDescription& sonar = settings.sonar;
  const double samples =
      (2 * (sonar.far_range - sonar.near_range) / sonar.sound_speed + sonar.pulse_length) * sonar.sampleRate();
  const double area = grid.rows * grid.range_step * grid.columns * grid.along_step;
  const double raw_and_compressed = 2 * sizeof(std::complex<float>) * samples * static_cast<double>(lines);
  const double scatterers = sizeof(Scatterer) * settings.speckle.density * area * 2;  // capacity of a growing vector
  const double image_and_reading = 4 * sizeof(std::complex<float>) * static_cast<double>(grid.pixels());
  return raw_and_compressed + scatterers + image_and_reading;
}

}  // namespace sas_motion::imaging
