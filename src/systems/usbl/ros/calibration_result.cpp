// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/calibration_result.hpp"

#include <fmt/format.h>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::ros_side {

using namespace usbl;

double inTableUnit(int unknown, double value) { return isAngle(unknown) ? value / kRadPerDeg : value; }

const char* tableUnit(int unknown) { return isAngle(unknown) ? "deg" : unknown == kRangeScale ? "-" : "m"; }

std::optional<State> CalibrationResult::truth() const {
  if (!recording.truth) return std::nullopt;
  return correctionTo(*recording.truth, recording.nominal);
}

std::vector<std::size_t> CalibrationResult::outliersByMinute() const {
  const auto& pings = comparison.problem.pings;
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < pings.size(); ++i) {
    const auto minute = static_cast<std::size_t>(secondsBetween(pings.front().stamp, pings[i].stamp) / 60);
    if (minute >= counts.size()) counts.resize(minute + 1);
    if (whitenedResidual(comparison, comparison.best(), i).cwiseAbs().maxCoeff() > kOutlier) ++counts[minute];
  }
  return counts;
}

std::string CalibrationResult::conclusion() const {
  const auto& observability = comparison.observability;
  if (!comparison.implausible.empty()) return "not to be trusted: " + comparison.implausible;
  if (!observability.observable) return observability.verdict;
  if (!comparison.agrees)
    return fmt::format(
        "not to be trusted: {} and batch disagree, their squared distance is {:.0f} where {:.1f} is the limit; it may "
        "have locked in to wrong readings",
        comparison.best().name, comparison.distance, agreementLimit());
  const bool alone = comparison.best().name == "batch";
  return fmt::format("observable: {}{}", observability.verdict,
                     alone ? "" : fmt::format("; {} and batch agree", comparison.best().name));
}

}  // namespace sas_motion::ros_side
