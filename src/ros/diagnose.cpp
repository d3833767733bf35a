// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the nodelets say on /diagnostics.
#include <fmt/format.h>

#include "sas_motion/ros/estimator_server.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kSilent = 5;            // a sensor without messages for so long is reported [s]
constexpr double kManyRejections = 0.5;  // share of measurements not fused or down-weighted that is reported

}  // namespace

void EstimatorServer::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "estimating");
  diagnoseSensors(status);
  for (const auto& lane : lanes_) diagnoseLane(lane, status);
  status.addf("callback to publication p50 [ms]", "%.3f", 1e3 * latency_.quantile(0.5));
  status.addf("callback to publication p99 [ms]", "%.3f", 1e3 * latency_.quantile(0.99));
  status.addf("whole callback p99 [ms]", "%.3f", 1e3 * callback_.quantile(0.99));
  status.addf("callbacks", "%lu", latency_.count());
}

void EstimatorServer::diagnoseSensors(diagnostic_updater::DiagnosticStatusWrapper& status) {
  Stamp newest = 0;
  for (int i = 0; i < Ingest::kSources; ++i) newest = std::max(newest, ingest_->counts(static_cast<Ingest::Source>(i)).newest);
  if (newest == 0) status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no data yet");
  for (int i = 0; i < Ingest::kSources; ++i) {
    const auto source = static_cast<Ingest::Source>(i);
    const auto& counts = ingest_->counts(source);
    const std::string name = Ingest::kNames[static_cast<std::size_t>(i)];
    status.addf(name + " messages", "%lu", counts.messages);
    status.addf(name + " lost", "%lu", counts.lost);
    status.addf(name + " of unknown frame", "%lu", counts.unknown_frame);
    status.addf(name + " without a reading", "%lu", counts.unusable);
    status.addf(name + " while disabled", "%lu", counts.disabled);
    if (counts.messages > 0) status.addf(name + " age [s]", "%.2f", secondsBetween(counts.newest, newest));
    if (counts.messages > 0 && secondsBetween(counts.newest, newest) > kSilent)
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, name + " is silent");
    if (!ingest_->enabled(source)) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, name + " is disabled");
    if (counts.unknown_frame > 0)
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, name + " has a frame without a transform to " + settings_.base_frame);
    if (counts.lost > 0) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, fmt::format("{} messages of {} lost", counts.lost, name));
  }
}

void EstimatorServer::diagnoseLane(const Lane& lane, diagnostic_updater::DiagnosticStatusWrapper& status) {
  std::uint64_t all = 0;
  for (const auto count : lane.verdicts) all += count;
  status.addf(lane.name + " accepted, down-weighted, rejected, stale, invalid", "%lu, %lu, %lu, %lu, %lu", lane.verdicts[0], lane.verdicts[1], lane.verdicts[2],
              lane.verdicts[3], lane.verdicts[4]);
  const double refused = all > 0 ? 1 - static_cast<double>(lane.verdicts[0]) / static_cast<double>(all) : 0;
  status.addf(lane.name + " not accepted [%]", "%.1f", 100 * refused);
  if (refused > kManyRejections) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, lane.name + " does not accept most of its measurements");
  if (const auto estimate = lane.estimator->current()) {
    const auto& P = estimate->belief.covariance;
    status.addf(lane.name + " 2-sigma position [m]", "%.3f", 2 * std::sqrt(P(0, 0) + P(1, 1)));
  } else {
    status.add(lane.name + " state", "starting");
  }
}

}  // namespace sas_motion::ros_side
