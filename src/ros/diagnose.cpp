// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the nodelets say on /diagnostics.
#include "ros/estimator_server.hpp"

namespace sas_motion::ros_side {

void EstimatorServer::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "estimating");
  diagnoseSources(ingest_->inbox(), Ingest::kNames, settings_, status);
  for (const auto& lane : lanes_) diagnoseLane(lane, status);
  diagnoseLatency(latency_, callback_, status);
}

void EstimatorServer::diagnoseLane(const Lane& lane, diagnostic_updater::DiagnosticStatusWrapper& status) {
  diagnoseVerdicts(lane.name, lane.verdicts, status);
  if (const auto estimate = lane.estimator->current()) {
    const auto& P = estimate->belief.covariance;
    status.addf(lane.name + " 2-sigma position [m]", "%.3f", 2 * std::sqrt(P(0, 0) + P(1, 1)));
  } else {
    status.add(lane.name + " state", "starting");
  }
}

}  // namespace sas_motion::ros_side
