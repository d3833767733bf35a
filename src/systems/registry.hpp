// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "bag/bag_output.hpp"
#include "campaign/suite.hpp"
#include "ros/system.hpp"

namespace sas_motion {

/// What the command line asks of a simulation.
struct SimulationRequest {
  std::string scenario;  ///< file
  std::uint64_t seed = 1;
  double duration = 0;  ///< instead of the scenario's; 0: the scenario's [s]
};
/// Gets the length of the simulation first, and then seconds as they pass.
using SimulationProgress = std::function<void(double total, double passed)>;

/// One system: everything that a tool or a nodelet needs to know of it. What a system has not is empty.
struct SystemRow {
  const char* name;  ///< as in `system:` of a file
  CampaignReader campaign;
  std::unique_ptr<ros_side::System> (*open)(YamlSection& config);
  void (*simulate)(const SimulationRequest& request, ros_side::BagOutput& bag, const SimulationProgress& progress);
};
const std::vector<SystemRow>& systems();

/// The system that a configuration file is of, `otherwise` where it does not say; the built-in settings of that where
/// no file is named. Throws ConfigError.
std::unique_ptr<ros_side::System> openSystem(const std::string& config, const std::string& otherwise = "towfish");
/// The readers of all systems' campaigns.
CampaignReaders campaignReaders();
/// Plays a scenario into a bag. Throws ConfigError.
void simulate(const SimulationRequest& request, ros_side::BagOutput& bag, const SimulationProgress& progress);

}  // namespace sas_motion
