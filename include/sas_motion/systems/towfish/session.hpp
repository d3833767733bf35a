// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/session/session_of.hpp"
#include "sas_motion/systems/towfish/solution.hpp"

namespace sas_motion::towfish {

/// Estimators of a towfish side by side.
class TowfishSession final : public SessionOf<Estimator> {
 public:
  /// See SessionOf.
  TowfishSession(const Config& config, const std::vector<std::string>& names, const EstimatorFactory& make,
                 bool live = true);

  std::string setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) override;
  bool positionsAreOfMap() const override { return true; }

 private:
  std::optional<Solution> solution(const Estimate& estimate, const OutputFrame& frame) const override;
};

}  // namespace sas_motion::towfish
