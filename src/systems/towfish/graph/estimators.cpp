// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/estimators.hpp"

#include "sas_motion/systems/towfish/smoother_recorder.hpp"
#include "systems/towfish/graph/batch.hpp"
#include "systems/towfish/graph/fixed_lag.hpp"

namespace sas_motion::towfish {

std::unique_ptr<Estimator> makeAnyEstimator(const std::string& name, const Config& config) {
  if (name == "batch")
    return std::make_unique<SmootherRecorder>(
        config, [options = config.batch](const SmoothingProblem& problem) { return smoothBatch(problem, options); });
  if (name == "gnc")
    return std::make_unique<SmootherRecorder>(
        config, [p = config.gnc_probability](const SmoothingProblem& problem) { return smoothGnc(problem, p); });
  if (name == "fixed_lag") return std::make_unique<FixedLagSmoother>(config);
  return makeEstimator(name, config);
}

const std::vector<std::string>& estimatorNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all(kFilterNames.begin(), kFilterNames.end());
    all.insert(all.end(), {"rts", "batch", "gnc", "fixed_lag"});
    return all;
  }();
  return names;
}

}  // namespace sas_motion::towfish
