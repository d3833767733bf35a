// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/estimator.hpp"

#include <algorithm>

#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"

namespace sas_motion::sins {

template <int N>
std::unique_ptr<ins::Estimator> makeNavigator(const NamedFilter& named, const Config& config);
extern template std::unique_ptr<ins::Estimator> makeNavigator<kPaperStates>(const NamedFilter&, const Config&);
extern template std::unique_ptr<ins::Estimator> makeNavigator<kStates>(const NamedFilter&, const Config&);

const std::vector<NamedFilter>& namedFilters() {
  using Kind = FilterKind;
  static const std::vector<NamedFilter> all{
      {"pf", Kind::Bootstrap},
      {"upf", Kind::Unscented},
      {"ss_srupf", Kind::SquareRoot},
      {"robust_ss_srupf", Kind::SquareRoot, Weighting::Mixture, false, true},
      {"steady_ss_srupf", Kind::SquareRoot, Weighting::Mixture, false, false, true},
      {"ss_srupf_optimal", Kind::SquareRoot, Weighting::OptimalProposal},
      {"ss_srupf_literal", Kind::SquareRoot, Weighting::Literal},
      {"ss_srukf", Kind::SquareRoot, Weighting::Mixture, true},
      {"ukf", Kind::Unscented, Weighting::Mixture, true}};
  return all;
}

const std::vector<std::string>& fusionNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& solution : ins::namedSolutions())
      if (solution.filter.feedback && solution.source == ins::Source::Fused) all.push_back(solution.name);
    return all;
  }();
  return names;
}

std::string currentName(const std::string& name) {
  return name == "smooth_ss_srupf" ? "steady_ss_srupf" : ins::currentName(name);
}

const NamedFilter* findFilter(const std::string& name) {
  const auto& all = namedFilters();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const NamedFilter& filter) { return filter.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Config startedAt(Config config, const ins::Config& other) {
  config.filters = other.filters;
  config.fixed_lag = other.fixed_lag;
  static_cast<ins::StartAndMounting&>(config.parameters) = other.parameters;
  return config;
}

std::unique_ptr<ins::Estimator> makeEstimator(const std::string& name, const Config& config) {
  const auto& fusions = fusionNames();
  if (std::find(fusions.begin(), fusions.end(), name) != fusions.end())
    return ins::makeEstimator(name, inSmallAngles(config));
  const NamedFilter* found = findFilter(name);
  if (!found) return nullptr;
  return config.accelerometer_bias ? makeNavigator<kStates>(*found, config)
                                   : makeNavigator<kPaperStates>(*found, config);
}

ins::Config inSmallAngles(const Config& config) {
  ins::Config other;
  other.parameters = inSmallAngles(config.parameters);
  other.imu = config.imu;
  other.filters = config.filters;
  other.fixed_lag = config.fixed_lag;
  return other;
}

}  // namespace sas_motion::sins
