// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sas_motion::towfish {
namespace {

void requirePositive(const char* key, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw std::invalid_argument(fmt::format("model: {} is {} but must be positive and finite", key, value));
}

/// The displacement through the water over a step, at the heading halfway through it.
struct Stride {
  Stride(const StateVector& x, const Input& input, double dt) {
    const double middle = x(kHeading) + 0.5 * dt * input.turn_rate;
    cosine = std::cos(middle);
    sine = std::sin(middle);
    length = dt * x(kSpeed);
  }
  double cosine, sine, length;
};

/// The current's Gauss-Markov process over a step of T: v' = decay v, position gains `reach` v, and the covariances
/// that white noise of density q = 2 beta sigma^2 leaves in (position, current).
struct CurrentStep {
  CurrentStep(const MotionParameters& p, double T) {
    const double tau = p.current_time_constant, u = T / tau, variance = p.current_sigma * p.current_sigma;
    const double lost = -std::expm1(-u);  // 1 - e^{-u}
    decay = 1 - lost;
    reach = tau * lost;
    velocity_velocity = variance * -std::expm1(-2 * u);
    position_velocity = variance * tau * lost * lost;
    // sigma^2 tau^2 (2u - 3 + 4 e^{-u} - e^{-2u}), by its series where the terms cancel
    const double u3 = u * u * u;
    const double bracket = u < 1e-3 ? u3 * (2.0 / 3 - u / 2 + 7 * u * u / 30) : 2 * u - 2 * lost - lost * lost;
    position_position = variance * tau * tau * bracket;
  }
  double decay, reach, velocity_velocity, position_velocity, position_position;
};

/// Adds to Q a random walk of density q in `state` that moves the position by (north, east) per second and unit of it.
void addRandomWalk(StateMatrix& Q, int state, double q, double north, double east, double T) {
  const double middle = q * T * T / 2, end = q * T * T * T / 3;
  Q(state, state) += q * T;
  Q(kNorth, state) += north * middle;
  Q(kEast, state) += east * middle;
  Q(kNorth, kNorth) += north * north * end;
  Q(kNorth, kEast) += north * east * end;
  Q(kEast, kEast) += east * east * end;
}

/// What all sensors' measurements have in common.
template <int M>
LinearMeasurement<kStates, M> linearized(const Measurement& z) {
  LinearMeasurement<kStates, M> result;
  result.H.setZero();
  result.R = z.variance.head<M>().asDiagonal();
  result.time = 1e-9 * static_cast<double>(z.stamp);
  result.source = sourceOf(z);
  return result;
}

LinearMeasurement<kStates, 1> scalar(const Measurement& z, State state, double innovation) {
  auto result = linearized<1>(z);
  result.innovation(0) = innovation;
  result.H(0, state) = 1;
  return result;
}

}  // namespace

const char* sensorName(Sensor sensor) {
  switch (sensor) {
    case Sensor::Position: return "position";
    case Sensor::Heading: return "heading";
    case Sensor::Speed: return "speed";
    case Sensor::TurnRate: return "turn_rate";
    case Sensor::Velocity: return "velocity";
  }
  return "unknown";
}

std::optional<Sensor> sensorFromName(const std::string& name) {
  for (int i = 0; i < kSensors; ++i)
    if (const auto sensor = static_cast<Sensor>(i); name == sensorName(sensor)) return sensor;
  return std::nullopt;
}

const char* implausibility(const Measurement& z) {
  if (z.sensor == Sensor::Position && z.value.norm() > 1e6) return "more than 1000 km from the datum";
  const bool fast = z.value.head(rowsOf(z.sensor)).norm() > 100;
  if ((z.sensor == Sensor::Speed || z.sensor == Sensor::Velocity) && fast) return "faster than 100 m/s";
  return nullptr;
}

Model::Model(const MotionParameters& parameters) : parameters_(parameters) {
  requirePositive("current_sigma", parameters.current_sigma);
  requirePositive("current_time_constant", parameters.current_time_constant);
  requirePositive("heading_noise", parameters.heading_noise);
  requirePositive("speed_noise", parameters.speed_noise);
  requirePositive("position_noise", parameters.position_noise);
}

StateVector Model::predict(const StateVector& x, const Input& input, double dt) const {
  const Stride stride(x, input, dt);
  const double lost = -std::expm1(-dt / parameters_.current_time_constant);
  StateVector next = x;
  next(kNorth) += parameters_.current_time_constant * lost * x(kCurrentNorth) + stride.length * stride.cosine;
  next(kEast) += parameters_.current_time_constant * lost * x(kCurrentEast) + stride.length * stride.sine;
  next(kCurrentNorth) -= lost * x(kCurrentNorth);
  next(kCurrentEast) -= lost * x(kCurrentEast);
  next(kHeading) = wrapAngle(x(kHeading) + dt * input.turn_rate);
  return next;
}

Transition<kStates> Model::transition(const StateVector& x, const Input& input, double dt) const {
  const Stride stride(x, input, dt);
  const CurrentStep current(parameters_, dt);
  Transition<kStates> step;
  step.mean = x;
  step.mean(kNorth) += current.reach * x(kCurrentNorth) + stride.length * stride.cosine;
  step.mean(kEast) += current.reach * x(kCurrentEast) + stride.length * stride.sine;
  step.mean(kCurrentNorth) *= current.decay;
  step.mean(kCurrentEast) *= current.decay;
  step.mean(kHeading) = wrapAngle(x(kHeading) + dt * input.turn_rate);

  step.F.setIdentity();
  step.F(kNorth, kCurrentNorth) = step.F(kEast, kCurrentEast) = current.reach;
  step.F(kCurrentNorth, kCurrentNorth) = step.F(kCurrentEast, kCurrentEast) = current.decay;
  step.F(kNorth, kHeading) = -stride.length * stride.sine;
  step.F(kEast, kHeading) = stride.length * stride.cosine;
  step.F(kNorth, kSpeed) = dt * stride.cosine;
  step.F(kEast, kSpeed) = dt * stride.sine;

  const double position = parameters_.position_noise * parameters_.position_noise * dt;
  StateMatrix& Q = step.Q;
  Q.setZero();
  Q(kNorth, kNorth) = Q(kEast, kEast) = current.position_position + position;
  Q(kNorth, kCurrentNorth) = Q(kEast, kCurrentEast) = current.position_velocity;
  Q(kCurrentNorth, kCurrentNorth) = Q(kCurrentEast, kCurrentEast) = current.velocity_velocity;
  const double speed = x(kSpeed);
  addRandomWalk(Q, kHeading, parameters_.heading_noise * parameters_.heading_noise, -speed * stride.sine,
                speed * stride.cosine, dt);
  addRandomWalk(Q, kSpeed, parameters_.speed_noise * parameters_.speed_noise, stride.cosine, stride.sine, dt);
  for (int col = 0; col < kStates; ++col)
    for (int row = col + 1; row < kStates; ++row) Q(row, col) = Q(col, row);
  return step;
}

StateVector Model::difference(const StateVector& y, const StateVector& x) {
  StateVector d = y - x;
  d(kHeading) = wrapAngle(d(kHeading));
  return d;
}

Vector<2> Model::expected(const Measurement& z, const StateVector& x) {
  switch (z.sensor) {
    case Sensor::Position: {
      const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
      const Vector<2>& arm = z.lever_arm_body;
      return {x(kNorth) + arm(0) * c - arm(1) * s, x(kEast) + arm(0) * s + arm(1) * c};
    }
    case Sensor::Heading: return {x(kHeading), 0};
    case Sensor::Speed: return {x(kSpeed), 0};
    case Sensor::Velocity: {
      const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
      return {x(kSpeed) + c * x(kCurrentNorth) + s * x(kCurrentEast), c * x(kCurrentEast) - s * x(kCurrentNorth)};
    }
    case Sensor::TurnRate: break;
  }
  return Vector<2>::Zero();
}

LinearMeasurement<kStates, 2> Model::position(const Measurement& z, const StateVector& x) const {
  auto result = linearized<2>(z);
  const Vector<2> h = expected(z, x);
  result.innovation = z.value - h;
  result.H(0, kNorth) = result.H(1, kEast) = 1;
  result.H(0, kHeading) = x(kEast) - h(1);  // d(arm turned by theta)/d(theta)
  result.H(1, kHeading) = h(0) - x(kNorth);
  return result;
}

LinearMeasurement<kStates, 1> Model::heading(const Measurement& z, const StateVector& x) const {
  return scalar(z, kHeading, wrapAngle(z.value(0) - x(kHeading)));
}

LinearMeasurement<kStates, 1> Model::speed(const Measurement& z, const StateVector& x) const {
  return scalar(z, kSpeed, z.value(0) - x(kSpeed));
}

LinearMeasurement<kStates, 2> Model::velocity(const Measurement& z, const StateVector& x) const {
  auto result = linearized<2>(z);
  const double c = std::cos(x(kHeading)), s = std::sin(x(kHeading));
  const Vector<2> h = expected(z, x);
  result.innovation = z.value - h;
  result.H(0, kSpeed) = 1;
  result.H(0, kCurrentNorth) = result.H(1, kCurrentEast) = c;
  result.H(0, kCurrentEast) = s;
  result.H(1, kCurrentNorth) = -s;
  result.H(0, kHeading) = h(1);
  result.H(1, kHeading) = x(kSpeed) - h(0);
  return result;
}

}  // namespace sas_motion::towfish
