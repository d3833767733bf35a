// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"
#include "sas_motion/simulation/simulator.hpp"

namespace sas_motion::towfish {

/// One law of a campaign: the noise that all sensors of the scenario get, or its own where there is none.
struct CampaignLaw {
  std::string name;
  std::optional<NoiseLaw> noise;
};

/// Monte Carlo of one scenario: laws x seeds x estimators.
struct Campaign {
  std::string name;
  Scenario scenario;
  Config config;
  std::vector<CampaignLaw> laws;
  std::vector<std::string> estimators;
  int runs = 100;
  std::uint64_t first_seed = 1;
  double skip = 20;  ///< start of each run that is not scored [s]

  /// Reads a suite; files named in it are relative to it. Throws ConfigError.
  static Campaign fromFile(const std::string& file);
};

/// What one estimator made of one run.
struct RunResult {
  std::string law, estimator;
  std::uint64_t seed = 0;
  Scores scores;
  std::vector<double> nees;  ///< of all six states at the first estimate in each scored second; NaN where there is none
  double seconds = 0;        ///< CPU time
  std::size_t measurements = 0;
};

using EstimatorFactory = std::function<std::unique_ptr<Estimator>(const std::string& name, const Config& config)>;

/// The name of the reference that is told which rows are outliers, and how large: a Kalman filter with their true variance.
constexpr const char* kOracle = "oracle_kf";

/// Simulates one run once and lets every estimator of the campaign work on it.
std::vector<RunResult> runOnce(const Campaign& campaign, const CampaignLaw& law, std::uint64_t seed, const EstimatorFactory& make);

/// Runs everything on `jobs` threads; results come in the order law, seed, estimator whatever the number of threads. `done` is called
/// after each run, from any thread.
std::vector<RunResult> runCampaign(const Campaign& campaign, int jobs, const EstimatorFactory& make, const std::function<void()>& done);

}  // namespace sas_motion::towfish
