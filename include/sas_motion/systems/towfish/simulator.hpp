// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/towfish/scenario.hpp"

namespace sas_motion::towfish {

/// The true state at a stamp. Its speed is through the water.
struct TruthSample {
  Stamp stamp = 0;
  StateVector state = StateVector::Zero();
  double turn_rate = 0;  ///< [rad/s]
  StateVector process_variance =
      StateVector::Ones();  ///< random walk: of the whitened noise of the step that led here, over the good one [-]
};

/// A measurement and, for each of its rows, whether its noise was an outlier and the true variance of its
/// variance.
struct LabelledMeasurement {
  Measurement z;
  std::array<bool, 2> outlier{};
  std::array<double, 2> variance{1, 1};  ///< over the good variance [-]
};

/// Plays a scenario step by step: truth, and what the sensors measure of it. The same scenario and seed give the same
/// numbers.
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
  bool draw(const SimulatedSource& source, LabelledMeasurement& labelled);

  Scenario scenario_;
  Model model_;
  long step_ = -1;
  TruthSample truth_;
  ProcessNoise process_;
  std::vector<NoiseSource> sensor_;    // two rows a source
  std::vector<Vector<2>> last_value_;  // of each source, for one that freezes
  std::vector<bool> measured_;         // whether there is one
  Random current_noise_;
  std::array<double, 3> phases_{};  // of the waves
  Vector<2> current_ = Vector<2>::Zero();
  double course_ = 0, leg_time_ = 0, turned_ = 0;
  int turn_side_ = 1;
  bool turning_ = false;
  std::vector<LabelledMeasurement> measurements_;
};

}  // namespace sas_motion::towfish
