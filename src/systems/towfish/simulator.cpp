// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/simulator.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/estimate/source_name.hpp"

namespace sas_motion::towfish {
namespace {

enum Stream : std::uint64_t {
  kProcessStream = 100,
  kSensorStream = 200,
  kCurrentStream = 300,
  kWaveStream = 400,
  kSpellStream = 1'000'000
};

/// Three waves near one period, of total standard deviation 1, and their rate of change.
struct Waves {
  double value = 0, rate = 0;
  Waves(double time, double period, const std::array<double, 3>& phases) {
    const std::array<double, 3> ratio{0.83, 1.0, 1.31};
    for (std::size_t i = 0; i < 3; ++i) {
      const double omega = 2 * kPi / (period * ratio[i]), amplitude = std::sqrt(2.0 / 3.0);
      value += amplitude * std::sin(omega * time + phases[i]);
      rate += amplitude * omega * std::cos(omega * time + phases[i]);
    }
  }
};

}  // namespace

Simulator::Simulator(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      model_(scenario.motion),
      process_(scenario.process, kStates, seed, kProcessStream),
      last_value_(scenario.sources.size(), Vector<2>::Zero()),
      measured_(scenario.sources.size()),
      current_noise_(seed, kCurrentStream) {
  for (std::uint64_t i = 0; i < 2 * scenario.sources.size(); ++i)
    sensor_.emplace_back(scenario.sources[i / 2].noise, seed, kSensorStream + i, kSpellStream + 10 * (i / 2));
  Random waves(seed, kWaveStream);
  for (auto& phase : phases_) phase = 2 * kPi * waves.uniform();
  current_ = scenario.current;
  course_ = scenario.heading;
}

bool Simulator::next() {
  ++step_;
  if (time() > scenario_.duration + 1e-9) return false;
  truth_.stamp = kStart + step_ * stampFromSeconds(scenario_.step);
  if (step_ == 0)
    begin();
  else if (scenario_.kind == Scenario::Kind::RandomWalk)
    moveRandomWalk();
  else
    moveSurvey();
  measure();
  return true;
}

void Simulator::begin() {
  if (scenario_.kind == Scenario::Kind::Survey)
    takeSurveyState(0);
  else
    truth_.state << 0, 0, current_, wrapAngle(scenario_.heading), scenario_.speed;
}

void Simulator::moveRandomWalk() {
  const auto step = model_.transition(truth_.state, Input{}, scenario_.step);
  const StateMatrix root = step.Q.llt().matrixL();
  const auto noise = process_.draw(time());
  truth_.state = step.mean + root * noise.value;
  truth_.process_variance = noise.variance;
  truth_.state(kHeading) = wrapAngle(truth_.state(kHeading));
}

void Simulator::moveCurrent() {
  const double decay = std::exp(-scenario_.step / scenario_.motion.current_time_constant);
  const double drive = scenario_.motion.current_sigma * std::sqrt(1 - decay * decay);
  for (int i = 0; i < 2; ++i)
    current_(i) =
        scenario_.current(i) + decay * (current_(i) - scenario_.current(i)) + drive * current_noise_.gaussian();
}

void Simulator::takeSurveyState(double course_rate) {
  const double now = time();
  const Waves yaw(now, scenario_.yaw_period, phases_), surge(now, 1.7 * scenario_.yaw_period, phases_);
  Vector<2> current = current_;
  if (scenario_.front.time >= 0)
    current += scenario_.front.change * 0.5 * (1 + std::tanh(2 * (now - scenario_.front.time) / scenario_.front.width));
  truth_.state.tail<4>() << current, wrapAngle(course_ + scenario_.yaw_sigma * yaw.value),
      scenario_.speed + scenario_.surge_sigma * surge.value;
  truth_.turn_rate = course_rate + scenario_.yaw_sigma * yaw.rate;
}

double Simulator::moveCourse() {
  const double dt = scenario_.step;
  leg_time_ += dt;
  double course_rate = 0;
  if (turning_) {
    course_rate = turn_side_ * scenario_.turn_rate;
    turned_ += scenario_.turn_rate * dt;
    if (turned_ >= kPi) {
      turning_ = false;
      turn_side_ = -turn_side_;
      leg_time_ = 0;
    }
  } else if (leg_time_ * scenario_.speed >= scenario_.line_length) {
    turning_ = true;
    turned_ = 0;
  }
  course_ += course_rate * dt;
  return course_rate;
}

void Simulator::moveSurvey() {
  moveCurrent();
  const double course_rate = moveCourse();
  const StateVector last = truth_.state;
  takeSurveyState(course_rate);
  StateVector& x = truth_.state;
  const double heading = last(kHeading) + 0.5 * wrapAngle(x(kHeading) - last(kHeading)),
               speed = 0.5 * (last(kSpeed) + x(kSpeed));
  x(kNorth) += scenario_.step * (0.5 * (last(kCurrentNorth) + x(kCurrentNorth)) + speed * std::cos(heading));
  x(kEast) += scenario_.step * (0.5 * (last(kCurrentEast) + x(kCurrentEast)) + speed * std::sin(heading));
}

void Simulator::measure() {
  measurements_.clear();
  for (std::size_t i = 0; i < scenario_.sources.size(); ++i) {
    const SimulatedSource& options = scenario_.sources[i];
    if (options.rate <= 0) continue;
    const long every = std::lround(1 / (options.rate * scenario_.step)),
               offset = std::lround(options.phase / scenario_.step);
    if (step_ < offset || (step_ - offset) % every != 0) continue;
    LabelledMeasurement labelled;
    Measurement& z = labelled.z;
    z.stamp = truth_.stamp;
    z.sensor = options.sensor;
    z.source = static_cast<int>(i);
    if (!options.name.empty()) z.source_name = lastingName(options.name);
    z.variance.setConstant(options.sigma * options.sigma);
    z.lever_arm_body = options.lever_arm_body;
    z.value = z.sensor == Sensor::TurnRate ? Vector<2>(truth_.turn_rate, 0) : Model::expected(z, truth_.state);
    if (draw(options, labelled)) measurements_.push_back(labelled);
  }
  std::stable_sort(measurements_.begin(), measurements_.end(),
                   [](const auto& a, const auto& b) { return before(a.z, b.z); });
}

bool Simulator::draw(const SimulatedSource& options, LabelledMeasurement& labelled) {
  Measurement& z = labelled.z;
  const auto source = static_cast<std::size_t>(z.source);
  bool missing = false;
  for (std::size_t row = 0; row < static_cast<std::size_t>(std::max(1, rowsOf(z.sensor))); ++row) {
    const NoiseSample noise = sensor_[2 * source + row].draw(time());
    double& value = z.value(static_cast<Eigen::Index>(row));
    value += options.sigma * noise.value;
    const double quantum = options.sigma * noise.quantum;
    if (quantum > 0) value = quantum * std::round(value / quantum);
    if (noise.frozen && measured_[source]) value = last_value_[source](static_cast<Eigen::Index>(row));
    labelled.outlier[row] = noise.outlier;
    labelled.variance[row] = noise.variance;
    missing |= row == 0 && noise.missing;  // a measurement is lost as a whole
  }
  if (z.sensor == Sensor::Heading) z.value(0) = wrapAngle(z.value(0));
  if (missing) return false;
  last_value_[source] = z.value;
  measured_[source] = true;
  return true;
}

}  // namespace sas_motion::towfish
