// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "campaign/report.hpp"
#include "sas_motion/imaging/focus_bench.hpp"

namespace sas_motion {

/// One outlier law of a campaign, as tables and plots name it.
struct LawInfo {
  std::string name, description;
  std::optional<double> epsilon, K;  ///< of a contamination; 0 and 1 where the noise is good
};

/// One system under several outlier laws, estimated by several estimators: what a campaign runs.
class System {
 public:
  virtual ~System() = default;

  std::string title, kind;        ///< of the campaign; of the system
  double duration = 0, skip = 0;  ///< of a run, and of its start that is not scored [s]
  int dimension = 0;              ///< of the state
  int particles = 0;              ///< of its particle filters; 0 where it has none
  std::vector<std::string> estimators;
  std::vector<LawInfo> laws;

  /// Simulates one run and lets every estimator work on it. The same law and seed give the same numbers, on any thread.
  virtual std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const = 0;
  /// The posterior Cramer-Rao bound on each group's RMSE over the scored time, averaged over the truths of `seeds`;
  /// empty where there is none.
  virtual Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const = 0;
  virtual Named<Trace> trace(std::size_t law, std::uint64_t seed) const = 0;
  /// Writes what every estimator of a run sees in its first aperture into a folder; nothing where the system makes no
  /// images.
  virtual std::optional<imaging::FocusResult> images(std::size_t, std::uint64_t, const std::string&) const {
    return std::nullopt;
  }
};

}  // namespace sas_motion
