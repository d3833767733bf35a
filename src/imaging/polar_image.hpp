// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

struct PolarPoint {
  double range = 0;   ///< from the aperture's centre [m]
  double cosine = 0;  ///< of the angle to the track [-]
};

/// One aperture's image of the grid's plane, with phases relative to a path of twice the range, at equal steps of range
/// and cosine.
class PolarImage {
 public:
  /// Adds `margin` samples of range on both sides of the grid.
  PolarImage(const ImageGrid& grid, const Eigen::Vector3d& centre, double range_step, double cosine_step, int margin);

  int ranges() const { return ranges_; }
  int cosines() const { return cosines_; }
  PolarPoint sample(int range, int cosine) const {
    return {first_.range + range * range_step_, first_.cosine + cosine * cosine_step_};
  }
  std::complex<float>& at(int range, int cosine) {
    return values_[static_cast<std::size_t>(cosine) * static_cast<std::size_t>(ranges_) +
                   static_cast<std::size_t>(range)];
  }

  PolarPoint seen(const Eigen::Vector3d& point) const;
  /// Gives the point of the plane; false where none is so near.
  bool place(const PolarPoint& polar, Eigen::Vector3d& point) const;
  /// Interpolates by eight taps in range and in cosine; zero outside.
  std::complex<float> between(const PolarPoint& polar) const;

 private:
  void coverGrid(const ImageGrid& grid, int margin);

  Eigen::Vector3d centre_, foot_, range_axis_, along_axis_;  // foot: the point of the plane below the centre
  double height_ = 0, range_step_, cosine_step_;
  PolarPoint first_;
  int ranges_ = 0, cosines_ = 0;
  std::vector<std::complex<float>> values_;
};

}  // namespace sas_motion::imaging
