// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/systems/usbl/comparison.hpp"
#include "systems/usbl/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// The data of a bag for a calibration.
struct UsblRecording {
  std::vector<usbl::Ping> pings;  ///< in the order of time, with the nominal array as body
  usbl::Mounting nominal;         ///< the identity where the bag has none
  bool has_nominal = false;
  std::optional<usbl::Mounting> truth;
  std::map<Stamp, std::array<bool, usbl::kChannels>> outlier;  ///< the simulator's labels, by stamp and channel
  std::string array_frame;
  Geodetic transponder;                           ///< the first one
  std::uint64_t readings = 0;                     ///< of the array
  std::map<std::string, std::uint64_t> left_out;  ///< readings that gave no ping, by reason in plain words
  std::map<std::string, std::uint64_t> refused;   ///< other messages without use, by reason

  /// Takes all but the pings from an ingest: nominal mounting, transponder and counts.
  void takeSummary(const UsblIngest& ingest);
  /// Throws std::runtime_error with one sentence that names the file and the topic where there is no ping.
  static UsblRecording read(const std::string& bag, const UsblSettings& settings,
                            const std::function<void(double)>& progress);
};

/// A calibration to print and write: the data and the estimators' results.
struct CalibrationResult {
  std::string bag;
  UsblSettings settings;
  UsblRecording recording;
  usbl::Comparison comparison;

  /// The true correction of the nominal mounting; nothing without truth.
  std::optional<usbl::State> truth() const;
  usbl::Mounting mounting() const {
    return usbl::corrected(recording.nominal, comparison.best().x.head<usbl::kStates>());
  }
  std::string arrayFrame() const { return recording.array_frame.empty() ? "usbl_link" : recording.array_frame; }
  /// Number of pings with an outlier in any channel of the answer, in each minute from the first ping on.
  std::vector<std::size_t> outliersByMinute() const;
  /// One sentence on whether to trust the answer.
  std::string conclusion() const;
};

/// Degrees for an angle; other unknowns stay.
double inTableUnit(int unknown, double value);
const char* tableUnit(int unknown);

/// The table for the terminal.
std::string calibrationTable(const CalibrationResult& result);
/// calibration.yaml.
std::string calibrationDocument(const CalibrationResult& result);
/// calibration.json: every estimator over time, for the report.
std::string calibrationTrace(const CalibrationResult& result);

}  // namespace sas_motion::ros_side
