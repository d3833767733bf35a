// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the nodelets do on request. All but ~solve_batch, see batch_solver.hpp.
#include <fmt/format.h>

#include <algorithm>

#include "ros/estimator_server.hpp"

namespace sas_motion::ros_side {

void EstimatorServer::advertiseServices() {
  services_ = {own_.advertiseService("reset", &EstimatorServer::onReset, this),
               own_.advertiseService("set_datum", &EstimatorServer::onSetDatum, this),
               own_.advertiseService("set_state", &EstimatorServer::onSetState, this),
               own_.advertiseService("enable_sensor", &EstimatorServer::onEnableSensor, this),
               own_.advertiseService("get_state_at", &EstimatorServer::onGetStateAt, this)};
}

bool EstimatorServer::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  startAnew();
  response.success = true;
  response.message = "estimators start anew";
  return true;
}

bool EstimatorServer::onSetDatum(SetDatum::Request& request, SetDatum::Response& response) {
  try {
    const LocalFrame frame({request.latitude, request.longitude, request.altitude});
    settings_.datum = frame.datum();
    startAnew();
    ingest_->setDatum(frame.datum());
    publishDatum();
    response.success = true;
    response.message = "datum set, estimators start anew";
  } catch (const std::invalid_argument& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

bool EstimatorServer::onSetState(SetState::Request& request, SetState::Response& response) {
  response.success = false;
  response.message = "no such estimator";
  Estimate state;
  state.stamp = stampOf(request.stamp);
  try {
    state.belief = beliefOf(request);
  } catch (const std::invalid_argument& error) {
    response.message = error.what();
    return true;
  }
  std::string refused;
  for (auto& lane : lanes_) {
    if (!request.estimator.empty() && request.estimator != lane.name) continue;
    const std::string reason = setState(lane, state);
    if (reason.empty()) response.success = true;
    if (!reason.empty()) refused += fmt::format("{}{}: {}", refused.empty() ? "" : "; ", lane.name, reason);
    response.message = refused;
  }
  response.success = response.success && refused.empty();
  return true;
}

/// Returns why not, or nothing.
std::string EstimatorServer::setState(Lane& lane, Estimate state) {
  if (state.stamp == 0) {
    const auto newest = lane.estimator->current();
    if (!newest) return "there is no estimate yet, so give a stamp";
    state.stamp = newest->stamp;
  }
  const char* reason = lane.estimator->setState(state, output_);
  queueSettled(lane);
  if (reason) return reason;
  open_ = true;
  publishNow(lane);
  return "";
}

bool EstimatorServer::onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response) {
  return enableSensor(
      Ingest::kNames,
      [this](std::size_t source, bool enabled) { ingest_->enable(static_cast<Ingest::Source>(source), enabled); },
      request, response);
}

bool EstimatorServer::onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response) {
  response.success = false;
  response.message = "no such estimator";
  for (const auto& lane : lanes_) {
    if (!request.estimator.empty() && request.estimator != lane.name) continue;
    const auto estimate = lane.estimator->at(stampOf(request.stamp));
    response.success = estimate.has_value();
    response.message =
        estimate ? "" : "the stamp is older than the lag, or the estimator has not started or keeps no history";
    if (estimate) {
      response.odometry = odometryOf(*estimate, settings_);
      response.current = currentOf(*estimate, settings_);
    }
    break;
  }
  return true;
}

}  // namespace sas_motion::ros_side
