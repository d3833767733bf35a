// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"

namespace sas_motion::imaging {

/// The least-squares line through a series over time.
struct Trend {
  double mean = 0;   ///< at the middle of the times
  double slope = 0;  ///< a second
  double rms = 0;    ///< of the residuals
};
/// The trend of `values` at `times` [s], as many of both.
Trend fitTrend(const std::vector<double>& times, const std::vector<double>& values);

/// A trajectory's error over one aperture, estimate less truth. Mean and slope move the image; the residuals blur it.
struct ApertureTrajectoryError {
  Trend along;          ///< along the track [m]
  Trend line_of_sight;  ///< positive: too far from the target [m]
  /// Shift of the image in the plane of the bottom, to the place whose estimated paths fit the target's true ones best
  /// [m].
  Eigen::Vector3d image_shift = Eigen::Vector3d::Zero();
  /// Error of half of each line's path: the estimated one by the shifted image, less the true one by the target. It
  /// contains the errors of attitude and velocity [m].
  Trend path;
};

/// The error in the frame of the aperture at the pings' times [s]; the line of sight starts at the mean true position.
ApertureTrajectoryError apertureTrajectoryError(const SonarDescription& sonar, const std::vector<double>& times,
                                                const std::vector<PingPose>& truth,
                                                const std::vector<PingPose>& estimate, const Eigen::Vector3d& target);

}  // namespace sas_motion::imaging
