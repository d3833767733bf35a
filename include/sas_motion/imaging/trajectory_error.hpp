// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/echo_path.hpp"

namespace sas_motion::imaging {

/// A series over time against its least-squares line.
struct Trend {
  double mean = 0;   ///< at the middle of the times
  double slope = 0;  ///< a second
  double rms = 0;    ///< of what is left without both
};
/// `values` at `times` [s], as many of both.
Trend fitTrend(const std::vector<double>& times, const std::vector<double>& values);

/// A trajectory's error over one aperture, computed less true. What is left without mean and trend blurs the image;
/// mean and trend move it.
struct ApertureTrajectoryError {
  Trend along;          ///< along the track [m]
  Trend line_of_sight;  ///< positive: too far from the target [m]
  /// How far the error moves the image, in the plane of the bottom: to the place whose estimated paths fit the true
  /// ones by the target best [m].
  Eigen::Vector3d image_shift = Eigen::Vector3d::Zero();
  Trend path;  ///< half of each line's path by the moved image, less the true one by the target: so with attitude and
               ///< velocity too [m]
};

/// Errors in the frame of the aperture at the pings' times [s], the line of sight being that from the middle of the
/// true positions.
ApertureTrajectoryError apertureTrajectoryError(const SonarDescription& sonar, const std::vector<double>& times,
                                                const std::vector<PingPose>& truth,
                                                const std::vector<PingPose>& estimate, const Eigen::Vector3d& target);

}  // namespace sas_motion::imaging
