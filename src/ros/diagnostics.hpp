// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <array>
#include <cstdint>
#include <string>

#include "ros/latency.hpp"
#include "ros/system_run.hpp"

/// What the servers behind the nodelets say on /diagnostics.
namespace sas_motion::ros_side {

using DiagnosticStatus = diagnostic_updater::DiagnosticStatusWrapper;

/// What is counted of one estimator's answers.
struct LaneCounts {
  std::array<std::uint64_t, 5> verdicts{};  ///< by Verdict
  double effective_size = 0;                ///< of the last settled update, see Audit
  void add(const Output& output);
};

/// Of each source messages, losses, and age; what is silent, disabled, or of an unknown frame; what the system waits
/// for and what is wrong with its data.
void diagnoseRun(const SystemRun& run, const MapSettings& settings, DiagnosticStatus& status);
/// `current` is the estimator's newest solution, or nothing.
void diagnoseLane(const std::string& name, const LaneCounts& counts, const std::optional<Solution>& current,
                  DiagnosticStatus& status);
void diagnoseLatency(const LatencyMeter& latency, const LatencyMeter& callback, DiagnosticStatus& status);

}  // namespace sas_motion::ros_side
