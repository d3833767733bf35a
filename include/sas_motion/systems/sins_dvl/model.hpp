// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/navigation/preintegration.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

/// A strapdown INS aided by a DVL, by errors that may be large: attitude errors are additive errors of the quaternion
/// [Yu1999, Li2014]; numbers as in docs/sins_dvl.md. Errors are computed minus true.
namespace sas_motion::sins {

/// Where each group of states begins; SI units.
enum State {
  kPosition = 0,        ///< latitude, longitude [rad], height [m]
  kVelocity = 3,        ///< east, north, up
  kQuaternion = 6,      ///< of q_nav_body, scalar first
  kGyro = 10,           ///< drift; body
  kDvlOffset = 13,      ///< of the forward velocity
  kDvlScale = 14,       ///< [-]
  kDvlAngle = 15,       ///< drift angle, to starboard
  kAccelerometer = 16,  ///< bias; body; of 19 states
};
constexpr int kPaperStates = 16;  ///< the paper's: accelerometers count as free of bias
constexpr int kStates = 19;

/// How wrong the sensors are, and the start. Section B.7 of the specification and, where that is silent, its defaults.
struct Parameters : ins::StartAndMounting {
  double gyro_constant = 0.1 * kDegPerHour;            ///< [rad/s]
  double angle_random_walk = 0.003 * kRadPerDeg / 60;  ///< [rad/sqrt(s)]
  double accelerometer_constant = 500 * kMicroG;       ///< [m/s^2]
  double velocity_random_walk = 10 * kMicroG;          ///< [m/s/sqrt(s)]
  double dvl_offset = 0.01;                            ///< [m/s]
  double dvl_offset_time = 600;                        ///< correlation time [s]
  double dvl_scale = 0.002;                            ///< [-]
  double dvl_angle = 0.2 * kRadPerDeg;                 ///< [rad]
  double dvl_angle_time = 600;                         ///< correlation time [s]
  Vector<3> dvl_white{0.006, 0.006, 0.018};            ///< starboard, forward, up [m/s]
  double depth_white = 0.1;                            ///< [m]
  double dvl_lever_sigma = 0;  ///< of the DVL's lever arm on each axis, for the factor graphs; 0: it is known [m]

  Parameters() : StartAndMounting{{0.06, 0.06, 1}, 0.05, 0.05 * kRadPerDeg, 0.3 * kRadPerDeg} {}
};

/// The same sensors and start for the fusion by small angles, without GPS.
ins::Parameters inSmallAngles(const Parameters& parameters);

/// q = [scalar, vector] as the state has it.
inline Vector<4> coefficients(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
/// [0, w] q = Y(q) w. Its columns are orthonormal for a unit quaternion.
Matrix<4, 3> leftTurn(const Eigen::Quaterniond& q);
/// q [0, w] = U(q) w.
Matrix<4, 3> rightTurn(const Eigen::Quaterniond& q);

/// Moves a state by preintegrated readings of an IMU that has the drift `eps` and the bias `nabla`.
NavigationState moved(const NavigationState& state, const Preintegration& preintegrated, const Vector<3>& eps,
                      const Vector<3>& nabla);

/// The error dynamics over an interval, exactly: the INS and the truth by an error are both moved, and
/// compared. (B.1)-(B.4)
template <int N>
class Motion {
 public:
  /// `ins`: at the interval's beginning.
  Motion(const Parameters& parameters, const NavigationState& ins, const Preintegration& preintegrated);

  Vector<N> operator()(const Vector<N>& x) const;
  /// Lower triangular root of the noise over the interval. States that are constants get a little of it, so that it has
  /// full rank. `besides`: more variance of velocity, position and attitude errors [m^2/s^2, m^2, rad^2], east, north,
  /// up.
  Matrix<N> noiseRoot(const Vector<9>& besides = Vector<9>::Zero()) const;

 private:
  NavigationState ins_, ins_moved_;
  Preintegration preintegrated_;
  Parameters parameters_;
  double offset_decay_, angle_decay_;
};

/// The truth by the INS and an error, and what sensors read there.
template <int N>
class View {
 public:
  explicit View(const NavigationState& ins) : ins_(ins) {}

  NavigationState corrected(const Vector<N>& x) const;
  /// (B.5) on the DVL's axes; `turning_body` is its velocity by turning about the INS.
  Vector<3> dvl(const Vector<N>& x, const Vector<3>& turning_body) const;
  /// Of the depth gauge, at a lever arm from the INS [m].
  double height(const Vector<N>& x, const Vector<3>& lever_body) const;
  /// The same error with a true quaternion of length one.
  Vector<N> constrained(const Vector<N>& x) const;
  /// Velocity, position and attitude errors [m/s, m, rad] east, north, up, to first order in a change of x.
  Matrix<9, N> solutionByError(const Vector<N>& x) const;

 private:
  NavigationState ins_;
};

/// A root of the noise of a quaternion that is turned about nav axes by angles of these variances [rad^2].
template <int N>
Matrix<N> turnRoot(const NavigationState& ins, const Vector<3>& variance);

/// The distribution of the errors at the start, of an INS with the state `ins`.
template <int N>
Gaussian<N> startBelief(const Parameters& parameters, const NavigationState& ins);

}  // namespace sas_motion::sins
