// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/stamp.hpp"
#include "sas_motion/math/types.hpp"

namespace sas_motion {

// Units that inertial sensors are specified in.
constexpr double kDegPerHour = kRadPerDeg / 3600;  ///< [rad/s]
constexpr double kMicroG = 9.80665e-6;             ///< [m/s^2]

/// Position, velocity and attitude of a body. The axes of nav are east, north, up at the body; those of body are
/// starboard, forward, up.
struct NavigationState {
  double latitude = 0, longitude = 0;  ///< [rad]
  double height = 0;                   ///< above the ellipsoid [m]
  Vector<3> velocity_nav = Vector<3>::Zero();
  Eigen::Quaterniond q_nav_body = Eigen::Quaterniond::Identity();
};

/// The vector from `origin` to a nearby `point`, by the radii at the origin: east, north, up [m].
Vector<3> displacement(const NavigationState& origin, const NavigationState& point);
/// Moves the position by metres east, north, up.
void displace(NavigationState& state, const Vector<3>& metres_nav);
/// Rotation vector phi of C' = (I - [phi x]) C, from the true attitude to the computed one; nav [rad].
Vector<3> attitudeError(const Eigen::Quaterniond& computed, const Eigen::Quaterniond& truth);

/// A reading of an IMU: means over the interval that ends at its stamp, as an IMU that integrates internally gives
/// them.
struct ImuReading {
  Stamp stamp = 0;
  Vector<3> rate_body = Vector<3>::Zero();   ///< of the body against inertial space [rad/s]
  Vector<3> force_body = Vector<3>::Zero();  ///< specific force [m/s^2]
};

/// How a reading of the IMU was used.
enum class ImuVerdict {
  Started,      ///< the first reading, of which only the stamp is used
  Integrated,   ///< as it came
  OffRate,      ///< integrated, but its interval differs from the period by more than half of it
  Bridged,      ///< integrated over a gap, in which the motion is uncertain
  OutOfOrder,   ///< not after the last one; left out
  Implausible,  ///< not finite, or more than the IMU can measure; left out
};

constexpr std::size_t kImuVerdicts = 6;

struct ImuStep {
  ImuVerdict verdict = ImuVerdict::Started;
  double dt = 0;  ///< the interval that was integrated [s]
};

/// Strapdown mechanisation in the local level frame. Rotation and velocity increments are corrected for coning and
/// sculling from the present and the last one [Savage1998, I eq 47, II eq 56]. It allocates nothing.
class Mechanisation {
 public:
  struct Options {
    double period = 0.01;      ///< of the IMU [s]
    double longest_gap = 0.1;  ///< longest interval that one reading can stand for [s]
    double max_rate = 20;      ///< [rad/s]
    double max_force = 200;    ///< [m/s^2]
  };

  /// Throws std::invalid_argument where an option is not positive.
  Mechanisation(const NavigationState& start, Stamp stamp, const Options& options);

  /// The verdict that step() would return, for callers that stop before the stamp of the reading.
  ImuVerdict judge(const ImuReading& reading) const;
  /// Integrates up to the reading's stamp, unless the verdict is that it is left out.
  ImuStep step(const ImuReading& reading);
  /// Integrates up to `stamp` with the means of a reading that ends there or later, without a verdict.
  void advance(const ImuReading& reading, Stamp stamp);

  const NavigationState& state() const { return state_; }
  Stamp stamp() const { return stamp_; }
  /// Mean specific force of the last interval, nav [m/s^2], and rate of the body against inertial space at its end,
  /// body [rad/s]. A mean rate would lag by half an interval, which brings waves into the velocity of a lever arm.
  const Vector<3>& force_nav() const { return force_nav_; }
  const Vector<3>& rate_body() const { return rate_body_; }

  /// Feedback: continues from a corrected state.
  void reset(const NavigationState& state) { state_ = state; }

 private:
  Options options_;
  NavigationState state_;
  Stamp stamp_;
  bool started_ = false;
  Vector<3> last_angle_ = Vector<3>::Zero(), last_velocity_ = Vector<3>::Zero();  // increments of the interval before
  double last_dt_ = 0;
  Vector<3> force_nav_ = Vector<3>::Zero(), rate_body_ = Vector<3>::Zero();
};

}  // namespace sas_motion
