// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "campaign/campaign.hpp"
#include "sas_motion/systems/towfish/estimator.hpp"
#include "sas_motion/systems/towfish/simulated_run.hpp"

/// Estimators that serve as reference: they know what the simulator drew, or by which law.
namespace sas_motion::towfish {

/// The sensors whose noise a law may change: those that measure the state.
inline std::vector<Sensor> noisySensors() {
  std::vector<Sensor> noisy;
  for (int i = 0; i < kSensors; ++i)
    if (const auto sensor = static_cast<Sensor>(i); rowsOf(sensor) > 0) noisy.push_back(sensor);
  return noisy;
}

/// Takes the output of an estimator part by part: a whole run of every estimator would not stay in the cache.
using Listener = std::function<void(const Output&)>;

/// Lets an estimator, a reference or one that `make` knows, work on a run under `scenario`; returns the CPU time that
/// it took, without the listener's [s].
double estimate(const Config& config, const Scenario& scenario, const SimulatedRun& run, const std::string& name,
                const EstimatorFactory& make, const Listener& listen);

}  // namespace sas_motion::towfish
