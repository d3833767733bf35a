// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sas_motion::ros_side {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

constexpr double kSilent = 5;            // a sensor without messages for so long is reported [s]
constexpr double kManyRejections = 0.5;  // share of measurements not fused or down-weighted that is reported
constexpr double kFewParticles = 5;      // of fewer, the spread is no measure of the error

void diagnoseSource(const MessageSource& source, const MessageCounts& counts, bool enabled, Stamp newest,
                    const MapSettings& settings, DiagnosticStatus& status) {
  const std::string& name = source.name;
  status.addf(name + " messages", "%lu", counts.messages);
  status.addf(name + " lost", "%lu", counts.lost);
  status.addf(name + " of unknown frame", "%lu", counts.unknown_frame);
  status.addf(name + " without a reading", "%lu", counts.unusable);
  status.addf(name + " while disabled", "%lu", counts.disabled);
  if (counts.messages > 0) status.addf(name + " age [s]", "%.2f", secondsBetween(counts.newest, newest));
  const bool expected = counts.messages > 0 && !source.may_fall_silent;
  if (expected && secondsBetween(counts.newest, newest) > kSilent)
    status.mergeSummary(Level::WARN, name + " is silent");
  if (!enabled) status.mergeSummary(Level::WARN, name + " is disabled");
  if (counts.unknown_frame > 0)
    status.mergeSummary(Level::ERROR, name + " has a frame without a transform to " + settings.base_frame);
  if (counts.lost > 0) status.mergeSummary(Level::WARN, fmt::format("{} messages of {} lost", counts.lost, name));
}

void diagnoseVerdicts(const std::string& name, const LaneCounts& counts, DiagnosticStatus& status) {
  const auto& of = counts.verdicts;
  std::uint64_t all = 0;
  for (const auto count : of) all += count;
  status.addf(name + " accepted, down-weighted, rejected, stale, invalid", "%lu, %lu, %lu, %lu, %lu", of[0], of[1],
              of[2], of[3], of[4]);
  const double refused = all > 0 ? 1 - static_cast<double>(of[0]) / static_cast<double>(all) : 0;
  status.addf(name + " not accepted [%]", "%.1f", 100 * refused);
  if (refused > kManyRejections) status.mergeSummary(Level::WARN, name + " does not accept most of its measurements");
}

}  // namespace

void LaneCounts::add(const Output& output) {
  for (const auto& audit : output.audits) {
    ++verdicts[static_cast<std::size_t>(audit.verdict)];
    if (audit.effective_size > 0) effective_size = audit.effective_size;
  }
}

void diagnoseRun(const SystemRun& run, const MapSettings& settings, DiagnosticStatus& status) {
  Stamp newest = 0;
  const auto& sources = run.sources();
  for (std::size_t i = 0; i < sources.size(); ++i) newest = std::max(newest, run.inbox().counts(i).newest);
  if (newest == 0) status.summary(Level::WARN, "no data yet");
  for (std::size_t i = 0; i < sources.size(); ++i)
    diagnoseSource(sources[i], run.inbox().counts(i), run.inbox().enabled(i), newest, settings, status);
  const std::string waits_for = run.waitsFor();
  status.add("start", waits_for.empty() ? "started" : "waiting: " + waits_for);
  if (!waits_for.empty()) status.mergeSummary(Level::WARN, "estimation has not started: " + waits_for);
  for (const auto& [key, value] : run.details()) status.add(key, value);
  for (const auto& warning : run.warnings()) status.mergeSummary(Level::WARN, warning);
}

void diagnoseLane(const std::string& name, const LaneCounts& counts, const std::optional<Solution>& current,
                  DiagnosticStatus& status) {
  diagnoseVerdicts(name, counts, status);
  if (counts.effective_size > 0) status.addf(name + " effective particles", "%.0f", counts.effective_size);
  if (counts.effective_size > 0 && counts.effective_size < kFewParticles)
    status.mergeSummary(Level::WARN,
                        name + " has next to all weight on a few particles; its covariance is not to be trusted");
  if (!current)
    status.add(name + " state", "no present answer");
  else if (current->has_covariance())
    status.addf(name + " 2-sigma position [m]", "%.3f",
                2 * std::sqrt(current->pose_covariance(0, 0) + current->pose_covariance(1, 1)));
}

void diagnoseLatency(const LatencyMeter& latency, const LatencyMeter& callback, DiagnosticStatus& status) {
  status.addf("callback to publication p50 [ms]", "%.3f", 1e3 * latency.quantile(0.5));
  status.addf("callback to publication p99 [ms]", "%.3f", 1e3 * latency.quantile(0.99));
  status.addf("whole callback p99 [ms]", "%.3f", 1e3 * callback.quantile(0.99));
  status.addf("callbacks", "%lu", latency.count());
}

}  // namespace sas_motion::ros_side
