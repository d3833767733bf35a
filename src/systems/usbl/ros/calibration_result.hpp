// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sas_motion/systems/usbl/comparison.hpp"
#include "systems/usbl/ros/recording.hpp"

namespace sas_motion::ros_side {

/// A calibration as it is printed and written: what the bag held, and what the estimators made of it.
struct CalibrationResult {
  std::string bag;
  UsblSettings settings;
  UsblRecording recording;
  usbl::Comparison comparison;

  /// What the answer should be, as a correction of the nominal mounting; nothing without truth.
  std::optional<usbl::State> truth() const;
  usbl::Mounting mounting() const {
    return usbl::corrected(recording.nominal, comparison.best().x.head<usbl::kStates>());
  }
  std::string arrayFrame() const { return recording.array_frame.empty() ? "usbl_link" : recording.array_frame; }
  /// Of the answer, in each minute from the first ping on: of any channel.
  std::vector<std::size_t> outliersByMinute() const;
  /// The last word on it: one sentence.
  std::string conclusion() const;
};

/// In degrees for an angle, in its own unit for the rest.
double inTableUnit(int unknown, double value);
const char* tableUnit(int unknown);

/// The table for the terminal.
std::string calibrationTable(const CalibrationResult& result);
/// calibration.yaml.
std::string calibrationDocument(const CalibrationResult& result);
/// calibration.json: every estimator over time, for the report.
std::string calibrationTrace(const CalibrationResult& result);

}  // namespace sas_motion::ros_side
