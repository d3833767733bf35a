// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"
#include "sas_motion/simulation/simulator.hpp"

namespace sas_motion::towfish {

/// One simulated run in memory: truth at every step, and the labelled measurements in the order of fusion.
class SimulatedRun {
 public:
  SimulatedRun(const Scenario& scenario, std::uint64_t seed) : step_(stampFromSeconds(scenario.step)) {
    Simulator simulator(scenario, seed);
    while (simulator.next()) {
      truth_.push_back(simulator.truth().state);
      measurements_.insert(measurements_.end(), simulator.measurements().begin(), simulator.measurements().end());
    }
  }

  const std::vector<StateVector>& truth() const { return truth_; }
  const std::vector<LabelledMeasurement>& measurements() const { return measurements_; }
  /// Truth at a stamp of a measurement.
  Reference at(Stamp stamp) const { return {truth_[static_cast<std::size_t>((stamp - Simulator::kStart) / step_)]}; }
  /// Whether any row of the measurement that an audit is of was an outlier.
  bool outlier(const Audit& audit) const {
    const auto found = std::lower_bound(measurements_.begin(), measurements_.end(), audit, [](const LabelledMeasurement& m, const Audit& a) {
      return m.z.stamp != a.stamp ? m.z.stamp < a.stamp : m.z.sensor < a.sensor;
    });
    return found->outlier[0] || found->outlier[1];
  }

 private:
  Stamp step_;
  std::vector<StateVector> truth_;
  std::vector<LabelledMeasurement> measurements_;
};

}  // namespace sas_motion::towfish
