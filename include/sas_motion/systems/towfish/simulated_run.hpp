// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/estimate/audit.hpp"
#include "sas_motion/systems/towfish/simulator.hpp"

namespace sas_motion::towfish {

/// One simulated run in memory: truth at every step, and the labelled measurements in the order of fusion.
class SimulatedRun {
 public:
  SimulatedRun(const Scenario& scenario, std::uint64_t seed) : step_(stampFromSeconds(scenario.step)) {
    const bool has_process_laws = scenario.kind == Scenario::Kind::RandomWalk && !scenario.process.laws.empty();
    Simulator simulator(scenario, seed);
    while (simulator.next()) {
      truth_.push_back(simulator.truth().state);
      if (has_process_laws) process_variance_.push_back(simulator.truth().process_variance);
      first_.push_back(measurements_.size());
      measurements_.insert(measurements_.end(), simulator.measurements().begin(), simulator.measurements().end());
    }
  }

  Stamp step() const { return step_; }
  const std::vector<StateVector>& truth() const { return truth_; }
  const std::vector<LabelledMeasurement>& measurements() const { return measurements_; }
  /// Of the whitened process noise of the step that led to each truth, over the good one [-]; empty where all of it is
  /// good.
  const std::vector<StateVector>& processVariance() const { return process_variance_; }
  /// The place of a stamp among the truths.
  std::size_t index(Stamp stamp) const { return static_cast<std::size_t>((stamp - Simulator::kStart) / step_); }
  /// Truth at a stamp of a measurement.
  const StateVector& at(Stamp stamp) const { return truth_[index(stamp)]; }
  /// Whether any row of the measurement that an audit is of was an outlier.
  bool outlier(const Audit& audit) const {
    auto found = measurements_.begin() + static_cast<std::ptrdiff_t>(first_[index(audit.stamp)]);
    while (sourceName(found->z) != audit.sensor) ++found;
    return found->outlier[0] || found->outlier[1];
  }

 private:
  Stamp step_;
  std::vector<StateVector> truth_, process_variance_;
  std::vector<LabelledMeasurement> measurements_;
  std::vector<std::size_t> first_;  // measurement of each step
};

}  // namespace sas_motion::towfish
