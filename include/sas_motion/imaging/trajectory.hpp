// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "sas_motion/imaging/echo_path.hpp"
#include "sas_motion/math/stamp.hpp"

namespace sas_motion::imaging {

/// Where the body was, in a local frame with z up; body x forward, y to port, z up.
struct TimedPose {
  Stamp stamp = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond q_local_body = Eigen::Quaterniond::Identity();
};

/// A stretch of time.
struct Gap {
  Stamp begin = 0, end = 0;
};

/// Poses over time, and what lies between them.
class Trajectory {
 public:
  Trajectory() = default;
  /// Poses in any order; of those with one stamp the last counts.
  explicit Trajectory(std::vector<TimedPose> poses);

  /// In order of time.
  const std::vector<TimedPose>& poses() const { return poses_; }
  /// Between two poses the position moves straight and the attitude by the shortest rotation, both evenly. Nothing
  /// before the first pose and after the last.
  std::optional<TimedPose> at(Stamp stamp) const;
  /// The first stretch of [begin, end] without poses that is longer than this [s], or that lies before the first pose
  /// or after the last, whatever its length.
  std::optional<Gap> firstGap(Stamp begin, Stamp end, double longest) const;

 private:
  std::vector<TimedPose> poses_;
};

/// The times of pings at this rate [Hz] over this duration [s].
std::vector<Stamp> pingStamps(Stamp begin, double duration, double ping_rate);

/// The sonar at each ping. Its velocity is the mean one until `interval` [s] later: the stretch in which the echo comes
/// in, so that two estimates of almost one stamp do not give a leap for a speed. Throws std::invalid_argument where the
/// trajectory does not reach from the first ping to an interval after the last.
std::vector<PingPose> pingPoses(const Trajectory& trajectory, const std::vector<Stamp>& pings, double interval);

}  // namespace sas_motion::imaging
