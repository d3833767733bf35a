// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/fitter.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"

namespace sas_motion::usbl {

/// The name of the reference that is told each channel's true variance: a ckf from the prior.
constexpr const char* kOracle = "oracle_ckf";

/// One law of a campaign: the noise that every channel gets, and what messages state of it.
struct CampaignLaw {
  std::string name;
  NoiseMix noise;
  double stated_factor = 1;  ///< variance that messages state, over that of good noise [-]
};

/// Monte Carlo of one calibration: laws x seeds x estimators.
struct Campaign {
  Scenario scenario;
  Config config;
  std::vector<CampaignLaw> laws;
  std::vector<std::string> estimators;
  double skip = 0;  ///< start of each run that is not scored [s]

  /// Reads one campaign of a suite; `folder` is where the files named in it are. Throws ConfigError.
  static Campaign read(YamlSection& yaml, const std::string& folder);
  Scenario scenarioUnder(const CampaignLaw& law) const;
};

/// What an estimator believes after a ping.
struct Estimate {
  double time = 0;  ///< since the start [s]
  Gaussian<kStates> belief;
  Vector<kChannels> noise = Vector<kChannels>::Ones();  ///< variance of each channel over the stated one
};

/// What an estimator made of a run.
struct Output {
  std::vector<Estimate> estimates;         ///< after every ping; of a fit one, at the end; none where it failed
  std::vector<Vector<kChannels>> weights;  ///< of every ping, NaN where it got none
  std::vector<double> nis;                 ///< likewise
  double seconds = 0;                      ///< of CPU time
};

/// Lets an estimator work on the pings of a run.
Output estimate(const Campaign& campaign, const std::vector<LabelledPing>& pings, const std::string& name,
                const FitterFactory& fitters);

/// Whether `estimate` knows a name.
bool isEstimator(const std::string& name, const FitterFactory& fitters);

}  // namespace sas_motion::usbl
