// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/sins_dvl/graph/estimators.hpp"

#include "systems/ins_gps_dvl/graph/smoother.hpp"

namespace sas_motion::sins {

std::unique_ptr<ins::Estimator> makeAnyEstimator(const std::string& name, const Config& config) {
  if (name == "batch" || name == "fixed_lag") return ins::makeAnyEstimator(name, inSmallAngles(config));
  return makeEstimator(name, config);
}

const std::vector<std::string>& anyEstimatorNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& filter : namedFilters()) all.push_back(filter.name);
    all.insert(all.end(), fusionNames().begin(), fusionNames().end());
    all.insert(all.end(), {"batch", "fixed_lag"});
    return all;
  }();
  return names;
}

}  // namespace sas_motion::sins
