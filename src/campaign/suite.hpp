// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "campaign/campaign.hpp"

namespace sas_motion {

/// Reads a campaign of one system; files that it names are relative to `folder`. Throws ConfigError.
using CampaignReader = std::function<std::unique_ptr<Campaign>(YamlSection& yaml, const std::string& folder)>;
/// By the system's name.
using CampaignReaders = std::map<std::string, CampaignReader>;

/// Campaigns over seeds: all that a benchmark runs.
struct Suite {
  std::string name;
  std::string hash;  ///< of everything that a run depends on, but for the number of runs
  int runs = 100;    ///< seeds a law
  std::uint64_t first_seed = 1;
  std::vector<std::unique_ptr<Campaign>> campaigns;

  /// Files named in a suite are relative to it. Throws ConfigError.
  static Suite fromFile(const std::string& file, const CampaignReaders& readers);

  /// A run: tasks are numbered by campaign, law, then seed.
  struct Task {
    const Campaign* campaign;
    std::size_t law;
    std::uint64_t seed;
  };
  std::size_t tasks() const;
  std::size_t firstTask(std::size_t campaign) const;
  Task task(std::size_t index) const;
};

}  // namespace sas_motion
