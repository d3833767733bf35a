// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "campaign/system.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "sas_motion/systems/usbl/fitter.hpp"
#include "systems/towfish/campaign.hpp"

namespace sas_motion {

/// Campaigns over seeds: all that a benchmark runs.
struct Suite {
  std::string name;
  std::string hash;  ///< of everything that a run depends on, but for the number of runs
  int runs = 100;    ///< seeds a law
  std::uint64_t first_seed = 1;
  std::vector<std::unique_ptr<System>> campaigns;

  /// Files named in a suite are relative to it; without `fitters`, `make_ins` and `make_sins`, campaigns of usbl,
  /// ins_gps_dvl and sins_dvl have filters only. Throws ConfigError.
  static Suite fromFile(const std::string& file, const towfish::EstimatorFactory& make,
                        const usbl::FitterFactory& fitters = {},
                        const ins::EstimatorFactory& make_ins = ins::makeEstimator,
                        const sins::EstimatorFactory& make_sins = sins::makeEstimator);

  /// A run: tasks are numbered by campaign, law, then seed.
  struct Task {
    const System* campaign;
    std::size_t law;
    std::uint64_t seed;
  };
  std::size_t tasks() const;
  std::size_t firstTask(std::size_t campaign) const;
  Task task(std::size_t index) const;
};

}  // namespace sas_motion
