// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/systems/towfish/filter_estimator.hpp"
#include "sas_motion/systems/towfish/rts.hpp"
#include "sas_motion/systems/towfish/smoother_recorder.hpp"

namespace sas_motion::towfish {
namespace {

/// The filter of this name and type, set up by `config`.
template <class Filter>
Filter filterOf(const std::string& name, const Config& config) {
  std::optional<Filter> made;
  withGuardedFilter<kStates>(name, config.filters, [&](const auto& filter) {
    if constexpr (std::is_same_v<std::decay_t<decltype(filter)>, Filter>) made.emplace(filter);
  });
  return *made;
}

}  // namespace

std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config) {
  std::unique_ptr<Estimator> estimator;
  withGuardedFilter<kStates>(name, config.filters, [&](const auto& filter) {
    using Filter = std::decay_t<decltype(filter)>;
    estimator = std::make_unique<FilterEstimator<Filter>>([name](const Config& c) { return filterOf<Filter>(name, c); },
                                                          config);
  });
  if (estimator) return estimator;
  if (name == "rts")
    return std::make_unique<SmootherRecorder>(
        config, [options = config.rts](const SmoothingProblem& problem) { return smoothRts(problem, options); });
  return nullptr;
}

bool suffices(const std::vector<Measurement>& measurements) {
  const auto has = [&](Sensor sensor) {
    return std::any_of(measurements.begin(), measurements.end(), [&](const auto& z) { return z.sensor == sensor; });
  };
  return has(Sensor::Position) && has(Sensor::Heading);
}

const char* invalidity(const Measurement& z, const Config& config) {
  if (z.stamp <= 0) return "no stamp";
  if (!z.value.allFinite() || !z.lever_arm_body.allFinite()) return "not finite";
  for (int row = 0; row < rowsOf(z.sensor); ++row)
    if (!(z.variance(row) > 1e-30) || !(z.variance(row) < 1e12)) return "no usable covariance";
  if (const char* reason = implausibility(z)) return reason;
  if (z.sensor == Sensor::TurnRate && std::abs(z.value(0)) > config.turn_rate_limit)
    return "turn rate beyond its limit";
  return nullptr;
}

Audit refusal(const Measurement& z, Verdict verdict, const char* reason) {
  return sas_motion::refusal(z.stamp, sourceName(z), rowsOf(z.sensor), verdict, reason);
}

}  // namespace sas_motion::towfish
