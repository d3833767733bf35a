// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "evaluation/estimator_scorer.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion::ins {

/// Feeds a recording in time order; `take` gets the output after each reading of the IMU and at the end. Returns the
/// CPU time without that of `take` [s].
double replay(Estimator& estimator, const Recording& recording, const std::function<void(const Output&)>& take);

/// Hands the errors of one estimator's solutions over a run to a scorer. The trace has the start too.
class RunScorer {
 public:
  using Watch = std::function<void(const TruthSample&, const NavigationSolution&)>;

  /// Keeps references to scenario and trajectory. `watch` sees every solution that is scored or traced.
  RunScorer(const std::string& estimator, const Scenario& scenario, const Trajectory& trajectory, double skip,
            Sensor traced = Sensor::Gps, const ApertureOptions& aperture = {}, Watch watch = {});

  /// Whether solutions of this time count: ten a second do [s].
  static bool counts(double time);
  void add(const NavigationSolution& solution);
  void add(const Audit& audit, const LabelledAiding& labelled);
  /// Lets an estimator work on a recording and adds all that it answers.
  void follow(Estimator& estimator, const Recording& recording);

  EstimatorScorer& scorer() { return scorer_; }

 private:
  /// `error` is of velocity, position and attitude [m/s, m, rad].
  void trace(const NavigationSolution& solution, double time, const Vector<9>& error);
  void addConsistency(double time, const Vector<9>& error, const Matrix<9>& P);

  const Scenario& scenario_;
  const Trajectory& trajectory_;
  double skip_;
  Sensor traced_;
  Watch watch_;
  EstimatorScorer scorer_;
};

}  // namespace sas_motion::ins
