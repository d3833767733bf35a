// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/stamp.hpp"
#include "sas_motion/math/types.hpp"

/// System 1: a towfish or a ship that moves along its heading through moving water [Zhu2007, eq 1-8].
namespace sas_motion::towfish {

constexpr int kStates = 6;

/// x = [n, e, v_N, v_E, theta, v]: position [m] in a local tangent plane, current [m/s], heading clockwise from north
/// [rad] and speed through the water along the heading [m/s].
enum State { kNorth, kEast, kCurrentNorth, kCurrentEast, kHeading, kSpeed };
using StateVector = Vector<kStates>;
using StateMatrix = Matrix<kStates>;

/// Sensors in the order in which measurements of the same stamp are fused.
enum class Sensor : std::uint8_t { Position, Heading, Speed, TurnRate, Velocity };
constexpr int kSensors = 5;

/// How many rows a sensor's measurement has; the turn rate is an input of the motion and has none.
constexpr int rowsOf(Sensor sensor) {
  return sensor == Sensor::Position || sensor == Sensor::Velocity ? 2 : sensor == Sensor::TurnRate ? 0 : 1;
}
const char* sensorName(Sensor sensor);
/// The sensor of this name, or nothing.
std::optional<Sensor> sensorFromName(const std::string& name);

/// One measurement. Position: north and east of the antenna [m]; heading [rad]; speed [m/s]; turn rate [rad/s]
/// clockwise.
struct Measurement {
  Stamp stamp = 0;
  Sensor sensor = Sensor::Position;
  Vector<2> value = Vector<2>::Zero();
  Vector<2> variance = Vector<2>::Ones();  ///< of the good noise, a row each
  Vector<2> lever_arm_body =
      Vector<2>::Zero();              ///< position only: antenna from the reference point, forward and starboard [m]
  int source = -1;                    ///< its instrument, below kMaxSources; below 0: the only one of its sensor
  const char* source_name = nullptr;  ///< of that source, for as long as the program runs
};

/// The number of a measurement's source.
inline int sourceOf(const Measurement& z) { return z.source < 0 ? static_cast<int>(z.sensor) : z.source; }
/// The name of a measurement's source, in audits.
inline const char* sourceName(const Measurement& z) { return z.source_name ? z.source_name : sensorName(z.sensor); }

/// Why no such sensor reads a value like this one, as a literal; null where one may.
const char* implausibility(const Measurement& z);

/// The order of fusion: by time, then by sensor, then by source.
inline bool before(const Measurement& a, const Measurement& b) {
  if (a.stamp != b.stamp) return a.stamp < b.stamp;
  return a.sensor != b.sensor ? a.sensor < b.sensor : sourceOf(a) < sourceOf(b);
}

/// What is known of the motion between two measurements.
struct Input {
  double turn_rate = 0;  ///< clockwise [rad/s]
};

/// The motion's noise and the current's law.
struct MotionParameters {
  double current_sigma = 0.5;               ///< standard deviation of each current component [m/s]
  double current_time_constant = 3600;      ///< 1 / beta: correlation time of the current [s]
  double heading_noise = 0.5 * kRadPerDeg;  ///< random walk of the heading [rad/sqrt(s)]
  double speed_noise = 0.05;                ///< random walk of the speed [m/s/sqrt(s)]
  double position_noise = 0.01;             ///< random walk of the position: what the model leaves out [m/sqrt(s)]
};

/// The motion and sensor model, written once: filters, smoothers, factors and the simulator use this object.
class Model {
 public:
  /// Throws std::invalid_argument where a parameter is not positive and finite.
  explicit Model(const MotionParameters& parameters);

  /// f: the state `dt` seconds later, by the midpoint rule in heading; the current decays exactly. (1), (6)
  StateVector predict(const StateVector& x, const Input& input, double dt) const;

  /// f(x), F = df/dx and Q over `dt` seconds about x; Q is the exact integral of the linearised noise (van Loan's, in
  /// closed form).
  Transition<kStates> transition(const StateVector& x, const Input& input, double dt) const;

  /// y - x with the heading wrapped.
  static StateVector difference(const StateVector& y, const StateVector& x);

  /// Calls `use` with the LinearMeasurement<6, 2> of a position or velocity or the LinearMeasurement<6, 1> of a heading
  /// or speed about x. (8)
  template <class Use>
  auto linearize(const Measurement& z, const StateVector& x, Use&& use) const {
    if (rowsOf(z.sensor) == 2) return use(z.sensor == Sensor::Position ? position(z, x) : velocity(z, x));
    return use(z.sensor == Sensor::Heading ? heading(z, x) : speed(z, x));
  }

  LinearMeasurement<kStates, 2> position(const Measurement& z, const StateVector& x) const;
  LinearMeasurement<kStates, 1> heading(const Measurement& z, const StateVector& x) const;
  LinearMeasurement<kStates, 1> speed(const Measurement& z, const StateVector& x) const;
  LinearMeasurement<kStates, 2> velocity(const Measurement& z, const StateVector& x) const;

  /// h(x): what a perfect sensor would read, in `value`'s rows.
  static Vector<2> expected(const Measurement& z, const StateVector& x);

  const MotionParameters& parameters() const { return parameters_; }

 private:
  MotionParameters parameters_;
};

}  // namespace sas_motion::towfish
