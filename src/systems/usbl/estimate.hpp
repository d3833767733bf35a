// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/problem.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"

namespace sas_motion::usbl {

/// The name of the reference with each channel's true variance: a ckf from the prior.
constexpr const char* kOracle = "oracle_ckf";

/// The belief of an estimator after a ping.
struct Estimate {
  double time = 0;  ///< since the start [s]
  Gaussian<kStates> belief;
  Vector<kChannels> noise = Vector<kChannels>::Ones();  ///< variance of each channel over the stated one
};

/// The output of an estimator over a run.
struct Output {
  std::vector<Estimate> estimates;         ///< after every ping; of a fit one, at the end; none where it failed
  std::vector<Vector<kChannels>> weights;  ///< of every ping, NaN where it got none
  std::vector<double> nis;                 ///< the same
  double seconds = 0;                      ///< of CPU time
};

/// Lets an estimator work on the pings of a run under `scenario`.
Output estimate(const Config& config, const Scenario& scenario, const std::vector<LabelledPing>& pings,
                const std::string& name, const FitterFactory& fitters);

/// Whether `estimate` accepts a name.
bool isEstimator(const std::string& name, const FitterFactory& fitters);

}  // namespace sas_motion::usbl
