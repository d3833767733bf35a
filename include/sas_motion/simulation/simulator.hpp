// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/simulation/scenario.hpp"

namespace sas_motion::towfish {

/// The true state at a stamp. Its speed is through the water.
struct TruthSample {
  Stamp stamp = 0;
  StateVector state = StateVector::Zero();
  double turn_rate = 0;  ///< [rad/s]
};

/// A measurement and, for each of its rows, whether its noise was an outlier.
struct LabelledMeasurement {
  Measurement z;
  std::array<bool, 2> outlier{};
};

/// Plays a scenario step by step: truth, and what the sensors measure of it. The same scenario and seed give the same numbers.
class Simulator {
 public:
  Simulator(const Scenario& scenario, std::uint64_t seed);

  /// Moves to the next step; false at the end of the scenario.
  bool next();
  const TruthSample& truth() const { return truth_; }
  /// Measurements of this step, in the order of fusion.
  const std::vector<LabelledMeasurement>& measurements() const { return measurements_; }
  double time() const { return static_cast<double>(step_) * scenario_.step; }

  static constexpr Stamp kStart = 1'600'000'000 * kNanosecondsPerSecond;  ///< stamp of every scenario's beginning

 private:
  void begin();
  void moveRandomWalk();
  void moveSurvey();
  void moveCurrent();
  /// Moves along lines and turns; returns the rate of the course.
  double moveCourse();
  /// Everything but the position, on the waves and in the front, at this step.
  void takeSurveyState(double course_rate);
  void measure();

  Scenario scenario_;
  Model model_;
  long step_ = -1;
  TruthSample truth_;
  std::vector<NoiseSource> process_;  // one a state
  std::vector<NoiseSource> sensor_;   // two rows a sensor
  Random current_noise_;
  std::array<double, 3> phases_{};  // of the waves
  Vector<2> current_ = Vector<2>::Zero();
  double course_ = 0, leg_time_ = 0, turned_ = 0;
  int turn_side_ = 1;
  bool turning_ = false;
  std::vector<LabelledMeasurement> measurements_;
};

}  // namespace sas_motion::towfish
