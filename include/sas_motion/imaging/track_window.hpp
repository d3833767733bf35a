// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion::imaging {

/// Where a window of this duration [s] may begin so that the track in it is straightest: the least RMS of the distance
/// from the least-squares line over the length, among windows at least half as long as the longest. Nothing where no
/// window is without a gap longer than `longest_gap` [s].
std::optional<Stamp> straightestWindow(const Trajectory& trajectory, double duration, double longest_gap);

/// Mean speed over ground along the path [m/s]; 0 for fewer than two poses.
double meanSpeed(const Trajectory& trajectory);

/// The local frame of one aperture: origin on the flat bottom under the middle of the track; x along the mean heading,
/// so that the beams look along y even where a current sets the track aside; y to port, z up.
struct ApertureFrame {
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0;  ///< mean one of the body, counter-clockwise from the map's x [rad]

  PingPose fromMap(const PingPose& pose_map) const;
};

/// The frame of these pings, `altitude` [m] above the bottom on average. Throws std::invalid_argument where there is
/// none.
ApertureFrame apertureFrame(const std::vector<PingPose>& poses_map, double altitude);

/// Poses of any trajectory in this frame, moved up or down so that they are `altitude` [m] above the bottom on average:
/// a sonar hears how high it is, so that a height which is wrong throughout does not move its image.
std::vector<PingPose> aperturePoses(const std::vector<PingPose>& poses_map, const ApertureFrame& frame,
                                    double altitude);

}  // namespace sas_motion::imaging
