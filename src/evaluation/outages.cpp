// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/outages.hpp"

#include <algorithm>
#include <cstdlib>

namespace sas_motion {
namespace {

constexpr double kShortest = 30;  // gap that is an outage [s]

/// Whether each audit is of a reading that is older by `offset`.
bool fits(Stamp offset, const std::vector<Stamp>& readings, const std::vector<Stamp>& audits) {
  if (!std::binary_search(readings.begin(), readings.end(), audits.back() - offset)) return false;
  auto reading = readings.begin();
  return std::all_of(audits.begin(), audits.end(), [&](Stamp audit) {
    while (reading != readings.end() && *reading + offset < audit) ++reading;
    return reading != readings.end() && *reading + offset == audit;
  });
}

std::optional<Outage> outage(Stamp from, Stamp to, const TrueTrack& truth, const std::vector<Solution>& estimates) {
  Outage found{secondsBetween(truth.points().front().stamp, from), secondsBetween(from, to), 0, -1};
  const Solution* last = nullptr;
  for (const auto& point : truth.points()) {
    if (point.stamp < from || point.stamp >= to) continue;
    if (last) found.distance += (point.position_map - last->position_map).head<2>().norm();
    last = &point;
  }
  for (const auto& estimate : estimates)
    if (estimate.stamp > from && estimate.stamp < to)
      if (const auto exact = truth.at(estimate.stamp))
        found.error_end = (estimate.position_map - exact->solution.position_map).head<2>().norm();
  return found.error_end >= 0 && found.distance > 0 ? std::optional(found) : std::nullopt;
}

}  // namespace

std::vector<Outage> outages(const std::vector<Stamp>& fixes, const TrueTrack& truth,
                            const std::vector<Solution>& estimates) {
  std::vector<Outage> found;
  for (std::size_t i = 1; i < fixes.size(); ++i)
    if (secondsBetween(fixes[i - 1], fixes[i]) >= kShortest)
      if (const auto one = outage(fixes[i - 1], fixes[i], truth, estimates)) found.push_back(*one);
  return found;
}

Stamp timeOffset(const std::vector<Stamp>& readings, const std::vector<Stamp>& audits) {
  if (audits.empty() || fits(0, readings, audits)) return 0;
  std::vector<Stamp> offsets;
  for (const Stamp reading : readings) offsets.push_back(audits.front() - reading);
  std::sort(offsets.begin(), offsets.end(), [](Stamp a, Stamp b) { return std::abs(a) < std::abs(b); });
  const auto found =
      std::find_if(offsets.begin(), offsets.end(), [&](Stamp offset) { return fits(offset, readings, audits); });
  return found == offsets.end() ? 0 : *found;
}

}  // namespace sas_motion
