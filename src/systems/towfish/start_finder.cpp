// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/start_finder.hpp"

namespace sas_motion::towfish {

std::optional<Gaussian<kStates>> StartFinder::find(Output& output) {
  while (!gathered_.empty()) {
    const Stamp first = gathered_.front().stamp, end = first + stampFromSeconds(window_);
    if (gathered_.back().stamp < end) return std::nullopt;
    std::vector<Measurement> window;
    for (const auto& z : gathered_)
      if (z.stamp <= end) window.push_back(z);
    if (auto belief = startingBelief(first, window, options_, current_sigma_)) return belief;
    refuseFirst(output);
  }
  return std::nullopt;
}

void StartFinder::refuseFirst(Output& output) {
  output.audits.push_back(refusal(gathered_.front(), Verdict::Stale, "before the first position and heading"));
  gathered_.pop_front();
}

void StartFinder::refuseAll(Output& output) {
  while (!gathered_.empty()) refuseFirst(output);
}

}  // namespace sas_motion::towfish
