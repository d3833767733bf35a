// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/session.hpp"

namespace sas_motion::towfish {

TowfishSession::TowfishSession(const Config& config, const std::vector<std::string>& names,
                               const EstimatorFactory& make, bool live)
    : SessionOf(
          config, config.max_gap, names, [this, make](const std::string& name) { return make(name, this->config()); },
          live) {}

std::optional<Solution> TowfishSession::solution(const Estimate& estimate, const OutputFrame& frame) const {
  return solutionOf(estimate, frame.map ? &*frame.map : nullptr);
}

std::string TowfishSession::setState(std::size_t lane, const OutputFrame&, const StateRequest& request) {
  Estimate state{request.stamp, beliefOf(request)};
  if (state.stamp == 0) {
    const auto& newest = timeline(lane).current();
    if (!newest) return "there is no estimate yet, so give a stamp";
    state.stamp = newest->stamp;
  }
  return setStart(lane, state);
}

}  // namespace sas_motion::towfish
