// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/system.hpp"
#include "sas_motion/systems/ins_gps_dvl/config.hpp"

namespace sas_motion::ros_side {

/// An INS and its sensors, set up by a configuration file: IMU, GNSS fixes, DVL, depth, and the velocity of GNSS
/// at the start.
class NavigationSystem : public System {
 public:
  std::unique_ptr<SystemRun> begin(const std::vector<std::string>& names, const tf2::BufferCore& transforms,
                                   bool live) const override;
  const ins::Settings& estimation() const { return estimation_; }

 protected:
  /// `make` makes the system's estimators; the velocity's topic may be empty.
  NavigationSystem(ins::EstimatorFactory make, const std::string& velocity_topic);
  /// Reads what all systems with an INS have beside the estimation's settings, and ends the file.
  void readRest(YamlSection& yaml);

  ins::Settings estimation_;
  ins::EstimatorFactory make_;
};

/// The fusion of INS, GNSS and DVL in 27 states. Throws ConfigError.
std::unique_ptr<System> openInsGpsDvl(YamlSection& yaml);

}  // namespace sas_motion::ros_side
