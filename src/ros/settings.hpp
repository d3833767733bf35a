// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/navigation/local_frame.hpp"

namespace sas_motion::ros_side {

/// Names of frames, and where the map is: what every configuration file of reprocess and of the estimators' nodelets
/// has.
struct MapSettings {
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  double frame_timeout = 2;       ///< a message of a frame not yet known waits this long for its transform [s]
  std::optional<Geodetic> datum;  ///< origin of the map frame; the first fix where there is none

  /// Reads the section frames and the datum. Throws ConfigError.
  void readMap(YamlSection& yaml);
};

}  // namespace sas_motion::ros_side
