// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/mechanisation.hpp"

/// Centralised fusion of INS, GPS and DVL by their errors [Qin2012]; numbers as in docs/ins_gps_dvl.md. Errors are
/// computed minus true; C' = (I - [phi x]) C.
namespace sas_motion::ins {

constexpr int kStates = 27;
/// Where each group of three begins. Positions are longitude, latitude, height, that is east, north, up.
enum State {
  kVelocity = 0,        ///< of the INS; nav
  kPosition = 3,        ///< of the INS
  kAttitude = 6,        ///< phi; nav
  kGyroConstant = 9,    ///< drift; body
  kGyroMarkov = 12,     ///< drift; body
  kAccelerometer = 15,  ///< bias; body
  kGpsPosition = 18,
  kDvlVelocity = 21,  ///< body; of a DVL that drifts: drift angle, forward, up
  kDvlPosition = 24,  ///< dead-reckoned from DVL and attitude
};
using Errors = Vector<kStates>;
using ErrorMatrix = Matrix<kStates>;

constexpr double kMilliradian = 1e-3, kDrift = 1e-6, kBias = 1e-3;  // units of the states [rad], [rad/s], [m/s^2]

/// A DVL whose error along the way wanders, and which is turned about its upward axis by an angle that wanders: what it
/// reads to starboard too much grows with the speed. (B.4)
struct DvlDrift {
  double offset = 0.01;             ///< of the forward velocity [m/s]
  double offset_time = 600;         ///< correlation time [s]
  double angle = 0.2 * kRadPerDeg;  ///< [rad]
  double angle_time = 600;          ///< correlation time [s]
};

/// How well the start is known, and where the sensors that every system with an INS has sit from it.
struct StartAndMounting {
  Vector<3> start_position{2, 2, 2};               ///< [m]
  double start_velocity = 0.05;                    ///< [m/s]
  double start_tilt = 0.01 * kRadPerDeg;           ///< [rad]
  double start_heading = 0.1 * kRadPerDeg;         ///< [rad]
  Vector<3> dvl_lever_body = Vector<3>::Zero();    ///< [m]
  Vector<3> depth_lever_body = Vector<3>::Zero();  ///< [m]
};

/// How wrong the sensors are: constants, first-order Markov processes and white noise. (C.4), its defaults.
struct Parameters : StartAndMounting {
  double gyro_constant = 0.02 * kDegPerHour;           ///< [rad/s]
  double gyro_markov = 0.01 * kDegPerHour;             ///< [rad/s]
  double gyro_time = 3600;                             ///< correlation time [s]
  double angle_random_walk = 0.003 * kRadPerDeg / 60;  ///< [rad/sqrt(s)]
  double accelerometer_constant = 100e-6 * 9.80665;    ///< [m/s^2]
  double velocity_random_walk = 10e-6 * 9.80665;       ///< [m/s/sqrt(s)]
  Vector<3> gps_markov{2, 2, 4};                       ///< [m]
  double gps_time = 60;                                ///< [s]
  Vector<3> gps_white{0.5, 0.5, 1};                    ///< [m]
  double dvl_markov = 0.01;                            ///< [m/s]
  double dvl_time = 300;                               ///< [s]
  std::optional<DvlDrift> dvl_drift;                   ///< in the place of dvl_markov
  Vector<3> dvl_white{0.01, 0.01, 0.01};               ///< starboard, forward, up [m/s]
  double dvl_rate = 5;                                 ///< readings that are dead-reckoned [1/s]
  double dvl_scale = 0;                                ///< that the filters do not know; 0 where there is none [-]
  double dvl_misalignment = 0;                         ///< the same, about each axis [rad]
  double dvl_lever_sigma = 0;                          ///< the same: how far dvl_lever_body is wrong on each axis [m]
  double depth_white = 0.1;                            ///< [m]
  Vector<3> gps_lever_body = Vector<3>::Zero();        ///< antenna from the INS [m]
  Vector<3> dpc_lever_body = Vector<3>::Zero();        ///< phase centre of the sonar's array [m]
};

/// The sensors that aid the INS.
enum class Sensor { Gps, Dvl, Depth, Dpc };
constexpr std::size_t kSensors = 4;
const char* sensorName(Sensor sensor);
constexpr int rowsOf(Sensor sensor) { return sensor == Sensor::Depth ? 1 : sensor == Sensor::Dpc ? 2 : 3; }
Vector<3>& leverOf(Parameters& parameters, Sensor sensor);

/// How the sonar's array moved from one ping to the next, by displaced phase centres: its mean velocity over the
/// ground, which stands for the one in the middle of the interval T. That leaves v'' T^2 / 24: for 0.3 m of heave in 6
/// s at most 0.6 mm/s at 0.2 s and 0.2 mm/s at 0.125 s.
struct ArrayVelocity {
  Vector<3> sight_body = -Vector<3>::UnitZ();  ///< unit vector along the line of sight, across the array
  Vector<2> velocity = Vector<2>::Zero();      ///< forward, and along the sight [m/s]
  Vector<2> variance = Vector<2>::Ones();      ///< [m^2/s^2]
};

/// A reading of one of the sensors that aid the INS.
struct Aiding {
  Stamp stamp = 0;
  Sensor sensor = Sensor::Gps;
  NavigationState fix;                          ///< GPS: position of the antenna; depth: height of the sensor
  Vector<3> velocity_body = Vector<3>::Zero();  ///< DVL: its velocity over the ground
  ArrayVelocity array;                          ///< DPC
  // Where the reading states more than the parameters.
  std::optional<Vector<3>> variance;    ///< of its white noise, a row each [m^2, m^2/s^2]
  std::optional<Vector<3>> lever_body;  ///< its sensor from the INS, from now on [m]
};

/// Velocity, position and attitude rows of the INS error dynamics in SI units, (rad, rad, m) for the position. (C.2),
/// with the derivative of gravity by latitude kept.
Matrix<9> inertialDynamics(const NavigationState& state, const Vector<3>& force_nav);

/// Rate of the body over the ground, from that against inertial space; body [rad/s].
Vector<3> rateOverGround(const NavigationState& ins, const Vector<3>& rate_body);

/// The linear model of the 27 errors. Its units make them alike in size: metres east, north, up at a fixed place, mrad,
/// urad/s, mm/s^2, m/s.
class ErrorModel {
 public:
  ErrorModel(const Parameters& parameters, const NavigationState& start);

  /// Means over one step of time: the INS's position, the force on it and its attitude.
  struct Motion {
    NavigationState state;
    Vector<3> force_nav;
    Matrix<3> C_nav_body;
  };

  /// F, (C.5), per second.
  ErrorMatrix dynamics(const Motion& motion) const;
  /// Phi = I + F T + F^2 T^2 / 2. (C.4)
  ErrorMatrix transitionMatrix(const Motion& motion, double T) const;
  /// Phi, and Q_d = T (Phi q Phi^T + q) / 2. (C.4)
  Transition<kStates> transition(const Motion& motion, double T, const Errors& mean) const;
  Gaussian<kStates> start() const;

  /// A fix of the antenna, minus the INS's. Innovations are z - h(x), so H = dh/dx of the errors x.
  LinearMeasurement<kStates, 3> gps(const NavigationState& ins, const NavigationState& fix, const Errors& mean) const;
  /// Velocity over the ground on the DVL's axes; `rate_body` is of the body against inertial space.
  LinearMeasurement<kStates, 3> dvl(const NavigationState& ins, const Vector<3>& rate_body,
                                    const Vector<3>& velocity_body, const Errors& mean) const;
  /// Height of the depth sensor.
  LinearMeasurement<kStates, 1> depth(const NavigationState& ins, double height, const Errors& mean) const;
  /// Velocity of the sonar's array forward and along its line of sight.
  LinearMeasurement<kStates, 2> dpc(const NavigationState& ins, const Vector<3>& rate_body, const ArrayVelocity& array,
                                    const Errors& mean) const;

  /// What a DVL at this velocity reads too much by its errors that wander, to first order in them; body [m/s].
  Vector<3> dvlError(const Vector<3>& velocity_body, const Errors& mean) const;

  /// Velocity of the INS over the ground from the DVL's reading; body.
  Vector<3> velocityOfIns(const NavigationState& ins, const Vector<3>& rate_body,
                          const Vector<3>& velocity_dvl_body) const;

  const Errors& unit() const { return unit_; }  ///< of each state: SI of part C = unit * state
  const Parameters& parameters() const { return parameters_; }
  /// Where a sensor sits from the INS [m].
  void place(Sensor sensor, const Vector<3>& lever_body) { leverOf(parameters_, sensor) = lever_body; }
  /// East, north, up of a position error in the model's metres, from longitude, latitude, height; and back.
  Vector<3> metresPerPosition() const { return unit_.segment<3>(kPosition).cwiseInverse(); }

 private:
  Matrix<3> dvlErrorByState(const Vector<3>& velocity_body) const;

  Parameters parameters_;
  Errors unit_;
  Errors density_;                  // of the white noise that drives each state, in its units squared per second
  Vector<3> dvl_sigma_, dvl_time_;  // of what wanders of the DVL
};

/// What a DVL makes of its velocity, by its scale and its small misalignment: (1 + s) (I - [mu x]).
Matrix<3> dvlDistortion(double scale, const Vector<3>& misalignment);

/// The INS without the errors that are estimated of it.
NavigationState corrected(const NavigationState& ins, const Errors& errors, const Errors& unit);

}  // namespace sas_motion::ins
