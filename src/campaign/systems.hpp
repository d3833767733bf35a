// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/system.hpp"
#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/systems/ins_gps_dvl/scenario.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"
#include "sas_motion/systems/usbl/fitter.hpp"
#include "systems/towfish/campaign.hpp"

namespace sas_motion {

/// The systems of a suite, each read from its campaign. Throw ConfigError.
std::unique_ptr<System> makeTowfishSystem(YamlSection& campaign, const std::string& folder,
                                          const towfish::EstimatorFactory& make);
std::unique_ptr<System> makeConstantVelocitySystem(YamlSection& campaign);
std::unique_ptr<System> makeUsblSystem(YamlSection& campaign, const std::string& folder,
                                       const usbl::FitterFactory& fitters);
std::unique_ptr<System> makeInsSystem(YamlSection& campaign, const std::string& folder,
                                      const ins::EstimatorFactory& make);
/// Fails where the build has no imaging.
std::unique_ptr<System> makeImagingSystem(YamlSection& campaign, const std::string& folder,
                                          const ins::EstimatorFactory& make);
std::unique_ptr<System> makeSinsSystem(YamlSection& campaign, const std::string& folder,
                                       const sins::EstimatorFactory& make);

/// The bound of each group of states, by its name; empty where one is not known at all.
template <int N>
Named<double> boundsOf(const MeanBound<N>& mean, const Named<std::vector<int>>& groups) {
  Named<double> bounds;
  for (const auto& [name, states] : groups) {
    const auto rmse = mean.rmse(states);
    if (!rmse) return {};
    bounds.emplace_back(name, *rmse);
  }
  return bounds;
}

/// The bound of the towfish's groups under a scenario, see System::bound().
Named<double> towfishBound(const towfish::Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

/// The bound of the groups of the fusion of INS, GPS and DVL, see System::bound(); "outage" is the position at the end
/// of each.
Named<double> insBound(const ins::Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

/// The bound of the groups of SINS and DVL, see System::bound(); "drift_percent" is the position at the end over the
/// way.
Named<double> sinsBound(const sins::Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds);

/// How a law is named and plotted.
LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process);

}  // namespace sas_motion
