// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>

#include "campaign/report.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion::ins {

/// Scores one solution over a run. Its trace has the start too, and weights and NIS of one sensor.
class Score {
 public:
  Score(const Scenario& scenario, double skip, const towfish::ApertureOptions& aperture = {},
        Sensor traced = Sensor::Gps)
      : scenario_(scenario), skip_(skip), aperture_(aperture), traced_(traced) {
    trace_.nees_degrees = 9;
    trace_.nis_degrees = rowsOf(traced);
  }

  void add(const TruthSample& truth, const NavigationSolution& solution);
  void add(const Audit& audit, const LabelledAiding& labelled);

  EstimatorReport report(const std::string& name) const;
  const Trace& trace() const { return trace_; }

 private:
  /// `error` and `P` are of velocity, position and attitude [m/s, m, rad].
  void trace(const NavigationSolution& solution, double time, const Vector<9>& error);
  void addConsistency(double time, const Vector<9>& error, const Matrix<9>& P);

  const Scenario& scenario_;
  double skip_;
  towfish::ApertureOptions aperture_;
  Sensor traced_;
  std::map<std::string, std::vector<double>> errors_, nees_;
  std::array<std::vector<double>, kSensors> nis_;
  std::vector<double> time_, along_, across_;
  towfish::Detection detection_;
  bool finite_ = true;
  LockOut lock_out_{1};
  Trace trace_;
};

}  // namespace sas_motion::ins
