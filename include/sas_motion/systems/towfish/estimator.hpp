// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/session/timeline.hpp"
#include "sas_motion/systems/towfish/config.hpp"
#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::towfish {

/// The state at a stamp, after everything measured at that stamp.
struct Estimate {
  Stamp stamp = 0;
  Gaussian<kStates> belief;
};

using Output = OutputOf<Estimate>;
using Estimator = InOrderEstimator<Measurement, Estimate, Estimate, Config>;
using EstimatorFactory = std::function<std::unique_ptr<Estimator>(const std::string& name, const Config& config)>;

/// Makes rts or a filter of withFilter(); null for any other name.
std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config);

// What the order of time needs to know of a measurement.
inline Stamp stampOf(const Measurement& z) { return z.stamp; }
/// Every sensor's stamps tell the time.
inline bool tellsTime(const Measurement&) { return true; }
/// Whether there are a position and a heading.
bool suffices(const std::vector<Measurement>& measurements);
/// Whether a measurement can be used at all; a literal that says why not, or null.
const char* invalidity(const Measurement& z, const Config& config);
/// The audit of a measurement that was not fused.
Audit refusal(const Measurement& z, Verdict verdict, const char* reason);
inline std::optional<Audit> refusalOf(const Measurement& z, Verdict verdict, const char* reason) {
  return refusal(z, verdict, reason);
}

}  // namespace sas_motion::towfish
