// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/math/stamp.hpp"

namespace sas_motion::imaging {

/// A pose of the body in a local frame with z up; body x forward, y to port, z up.
struct TimedPose {
  Stamp stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond q_local_body = Eigen::Quaterniond::Identity();
};

struct Gap {
  Stamp begin = 0, end = 0;
};

/// Poses over time, interpolated between their stamps.
class Trajectory {
 public:
  Trajectory() = default;
  /// Takes poses in any order; the last of those with one stamp counts.
  explicit Trajectory(std::vector<TimedPose> poses);

  /// In order of time.
  const std::vector<TimedPose>& poses() const { return poses_; }
  /// Interpolates position linearly and attitude by slerp. Nothing before the first pose and after the last.
  std::optional<TimedPose> at(Stamp stamp) const;
  /// The first part of [begin, end] without poses that is longer than `longest` [s], or that lies before the first pose
  /// or after the last.
  std::optional<Gap> firstGap(Stamp begin, Stamp end, double longest) const;

 private:
  std::vector<TimedPose> poses_;
};

/// The times of pings at this rate [Hz] over this duration [s].
std::vector<Stamp> pingStamps(Stamp begin, double duration, double ping_rate);

/// The sonar's pose at each ping, with the mean velocity until `interval` [s] later, in which the echo arrives. Throws
/// std::invalid_argument where the trajectory does not reach from the first ping to an interval after the last.
std::vector<PingPose> pingPoses(const Trajectory& trajectory, const std::vector<Stamp>& pings, double interval);

/// Begin of the window of this duration [s] with the straightest track: with the least RMS distance from the
/// least-squares line over the length, among windows at least half as long as the longest. Nothing where every window
/// has a gap longer than `longest_gap` [s].
std::optional<Stamp> straightestWindow(const Trajectory& trajectory, double duration, double longest_gap);

/// Mean speed over ground along the path [m/s]; 0 for fewer than two poses.
double meanSpeed(const Trajectory& trajectory);

/// The local frame of one aperture: origin on the flat bottom under the middle of the track; x along the mean heading
/// (not the course, so that the beams look along y in a current), y to port, z up.
struct ApertureFrame {
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();  ///< [m]
  double yaw = 0;                                        ///< mean of the body, counter-clockwise from the map's x [rad]

  PingPose fromMap(const PingPose& pose_map) const;
};

/// The frame of pings that are `altitude` [m] above the bottom on average. Throws std::invalid_argument without pings.
ApertureFrame apertureFrame(const std::vector<PingPose>& poses_map, double altitude);

/// Poses of any trajectory in this frame, with heights shifted so that they are `altitude` [m] above the bottom on
/// average: a sonar measures its altitude, so a constant error of height does not move its image.
std::vector<PingPose> aperturePoses(const std::vector<PingPose>& poses_map, const ApertureFrame& frame,
                                    double altitude);

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
