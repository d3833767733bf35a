// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion::ins {

/// One of the body's swings in the sea: amplitude * sin(2 pi t / period + phase).
struct Wave {
  double amplitude = 0, period = 6, phase = 0;  ///< [m, rad], [s], [rad]
};

/// Parallel lines with turns by 180 degrees, to starboard and to port in turn, in waves.
struct Track {
  Geodetic start{54.35, 10.15, 0};
  double speed = 2;                   ///< over the ground [m/s]
  double heading = 0.5;               ///< of the first line [rad]
  double line_length = 400;           ///< [m]
  double turn_rate = 4 * kRadPerDeg;  ///< largest in a turn [rad/s]
  Wave pitch{2 * kRadPerDeg, 6, 0.8}, roll{3 * kRadPerDeg, 7, 0.8}, yaw{1 * kRadPerDeg, 10, 0.8};
  Wave heave{0.3, 6, 0}, sway{0.3, 7, 1};
  bool along_bow = false;  ///< the way goes where the bow points, which yaws and pitches, as a towed body's does; else
                           ///< along the course
};

/// The true motion at a time.
struct TruthSample {
  NavigationState state;
  Vector<3> acceleration_nav;  ///< derivative of velocity_nav
  Vector<3> rate_nav_body;     ///< of the body against nav; body [rad/s]
  double course = 0;           ///< of the track without waves [rad]
  double turn_rate = 0;        ///< of the course; 0 on a line [rad/s]

  /// Of the body against inertial space, and specific force; body. (0.4)
  Vector<3> rateBody() const;
  Vector<3> forceBody() const;
};

/// Position, velocity, acceleration, attitude and its rate as functions of time, each the exact derivative of the
/// other: turns are a fifth degree polynomial of the course, the way along them a Gauss quadrature.
class Trajectory {
 public:
  /// Throws std::invalid_argument where a speed, rate, length or period is not positive.
  Trajectory(const Track& track, double duration);

  TruthSample at(double time) const;
  /// What a unit without errors reads from `begin` to `end`: means by Gauss quadrature.
  ImuReading imu(double begin, double end) const;

 private:
  struct Course {
    double angle, rate;
  };
  Course course(double time) const;
  /// Direction of the way, and its derivative; east, north, up.
  struct Direction {
    Vector<3> unit, rate;
  };
  Direction direction(double time) const;
  /// Without heave and sway, from a node to a later time; east, north, up [m].
  Vector<3> way(double begin, double end) const;

  Track track_;
  double line_time_, turn_time_;
  std::vector<Vector<3>> nodes_;  // the way up to multiples of kNode
};

}  // namespace sas_motion::ins
