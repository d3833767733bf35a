// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/polar_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sas_motion/imaging/interpolator.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kTaps = 8, kBefore = kTaps / 2 - 1, kPhases = 1024;
using Taps = std::array<float, kTaps>;

/// Kaiser-windowed sinc for lines at twice their bandwidth; about -58 dB.
const std::vector<Taps>& tapTable() {
  static const std::vector<Taps> table = [] {
    std::vector<Taps> rows(kPhases + 1);
    for (int phase = 0; phase <= kPhases; ++phase)
      for (int tap = 0; tap < kTaps; ++tap)
        rows[static_cast<std::size_t>(phase)][static_cast<std::size_t>(tap)] =
            static_cast<float>(kaiserSinc(static_cast<double>(phase) / kPhases + kBefore - tap, kTaps, 5.4));
    return rows;
  }();
  return table;
}

/// The first tap's sample and the taps for a position among samples.
struct Place {
  int first = 0;
  const Taps* taps = nullptr;
  explicit Place(double position) {
    const double floor = std::floor(position);
    first = static_cast<int>(floor) - kBefore;
    taps = &tapTable()[static_cast<std::size_t>(std::lround((position - floor) * kPhases))];
  }
  bool inside(int samples) const { return first >= 0 && first + kTaps <= samples; }
};

}  // namespace

PolarImage::PolarImage(const ImageGrid& grid, const Eigen::Vector3d& centre, double range_step, double cosine_step,
                       int margin)
    : centre_(centre),
      range_axis_(grid.range_axis),
      along_axis_(grid.along_axis),
      range_step_(range_step),
      cosine_step_(cosine_step) {
  const Eigen::Vector3d normal = along_axis_.cross(range_axis_);
  height_ = (centre - grid.origin).dot(normal);
  foot_ = centre - height_ * normal;
  coverGrid(grid, margin);
}

void PolarImage::coverGrid(const ImageGrid& grid, int margin) {
  constexpr int kSteps = 64, kCosineMargin = 6;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PolarPoint least{kInfinity, kInfinity}, most{-kInfinity, -kInfinity};
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const PolarPoint polar = seen(grid.point((grid.rows - 1.0) * i / kSteps, (grid.columns - 1.0) * k / kSteps));
      least = {std::min(least.range, polar.range), std::min(least.cosine, polar.cosine)};
      most = {std::max(most.range, polar.range), std::max(most.cosine, polar.cosine)};
    }
  first_ = {least.range - margin * range_step_, least.cosine - kCosineMargin * cosine_step_};
  ranges_ = static_cast<int>(std::ceil((most.range - least.range) / range_step_)) + 2 * margin + 1;
  cosines_ = static_cast<int>(std::ceil((most.cosine - least.cosine) / cosine_step_)) + 2 * kCosineMargin + 1;
  values_.resize(static_cast<std::size_t>(ranges_) * static_cast<std::size_t>(cosines_));
}

PolarPoint PolarImage::seen(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d way = point - centre_;
  const double range = way.norm();
  return {range, way.dot(along_axis_) / range};
}

bool PolarImage::place(const PolarPoint& polar, Eigen::Vector3d& point) const {
  const double along = polar.range * polar.cosine,
               across_squared = polar.range * polar.range - along * along - height_ * height_;
  if (!(across_squared >= 0)) return false;
  point = foot_ + std::sqrt(across_squared) * range_axis_ + along * along_axis_;
  return true;
}

std::complex<float> PolarImage::between(const PolarPoint& polar) const {
  const Place range((polar.range - first_.range) / range_step_), cosine((polar.cosine - first_.cosine) / cosine_step_);
  if (!range.inside(ranges_) || !cosine.inside(cosines_)) return 0;
  float real = 0, imaginary = 0;
  for (int k = 0; k < kTaps; ++k) {
    const auto* const samples = reinterpret_cast<const float*>(
        &values_[static_cast<std::size_t>(cosine.first + k) * static_cast<std::size_t>(ranges_) +
                 static_cast<std::size_t>(range.first)]);
    float re = 0, im = 0;
    for (std::size_t i = 0; i < kTaps; ++i) {
      re += (*range.taps)[i] * samples[2 * i];
      im += (*range.taps)[i] * samples[2 * i + 1];
    }
    real += (*cosine.taps)[static_cast<std::size_t>(k)] * re;
    imaginary += (*cosine.taps)[static_cast<std::size_t>(k)] * im;
  }
  return {real, imaginary};
}

}  // namespace sas_motion::imaging
