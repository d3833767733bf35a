// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/systems/towfish/simulated_run.hpp"

namespace sas_motion::towfish {

/// The sensors whose noise a law may change.
constexpr std::array<Sensor, 3> kNoisy{Sensor::Position, Sensor::Heading, Sensor::Speed};

/// One law of a campaign: the noise that position, heading and speed get; what is not there stays as in the scenario.
struct CampaignLaw {
  std::string name;
  std::optional<NoiseMix> noise;
  std::map<Sensor, NoiseMix> sensors;  ///< of single sensors, before `noise`
  std::optional<NoiseMix> process;     ///< of a random walk
};

/// Monte Carlo of one scenario: laws x seeds x estimators.
struct Campaign {
  Scenario scenario;
  Config config;
  std::vector<CampaignLaw> laws;
  std::vector<std::string> estimators;
  double skip = 20;  ///< start of each run that is not scored [s]

  /// Reads one campaign of a suite; `folder` is where the files named in it are. Throws ConfigError.
  static Campaign read(YamlSection& yaml, const std::string& folder);
  Scenario scenarioUnder(const CampaignLaw& law) const;
};

/// The name of the reference that is told the true variance of each row and of each draw of process noise: a Kalman
/// filter.
constexpr const char* kOracle = "oracle_kf";
/// The name of the reference that is told the law of the noise, but not which readings are bad: a Gaussian sum.
constexpr const char* kBayesReference = "bayes_reference";

/// Takes what an estimator says of a run, part by part: a whole run of every estimator would not stay in the cache.
using Listener = std::function<void(const Output&)>;

/// Lets an estimator work on a run under `scenario`; returns the CPU time that it took, without the listener's [s].
double estimate(const Campaign& campaign, const Scenario& scenario, const SimulatedRun& run, const std::string& name,
                const EstimatorFactory& make, const Listener& listen);

}  // namespace sas_motion::towfish
