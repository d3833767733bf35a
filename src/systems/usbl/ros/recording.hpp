// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systems/usbl/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// What a bag holds for a calibration.
struct UsblRecording {
  std::vector<usbl::Ping> pings;  ///< in the order of time; their body is the nominal array
  usbl::Mounting nominal;         ///< the identity where the bag has none
  bool has_nominal = false;
  std::optional<usbl::Mounting> truth;
  std::map<Stamp, std::array<bool, usbl::kChannels>> outlier;  ///< the simulator's labels, by stamp and channel
  std::string array_frame;
  Geodetic transponder;        ///< the first one
  std::uint64_t readings = 0;  ///< that the bag has of the array
  std::map<std::string, std::uint64_t>
      left_out;  ///< readings that gave no ping, by reason in plain words; only what occurred
  std::map<std::string, std::uint64_t> refused;  ///< other messages that gave nothing

  /// What an ingest knows beside the pings: where the array sits nominally, the transponder, and what it left out.
  void takeSummary(const UsblIngest& ingest);
  /// Throws std::runtime_error: one sentence that names the file and the topic where there is no ping to calibrate
  /// with.
  static UsblRecording read(const std::string& bag, const UsblSettings& settings,
                            const std::function<void(double)>& progress);
};

}  // namespace sas_motion::ros_side
