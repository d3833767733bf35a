// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the server does on request. All but ~solve_batch, see batch_solver.hpp.
#include <Eigen/Cholesky>
#include <algorithm>

#include "ros/server.hpp"
#include "ros/serving.hpp"

namespace sas_motion::ros_side {
namespace {

/// The covariance of independent errors. Throws std::invalid_argument where a standard deviation is none.
Matrix<6> covarianceOf(const Vector<6>& sigmas) {
  if (!(sigmas.array() > 0).all())
    throw std::invalid_argument("covariance is not positive definite: a standard deviation is not above 0");
  return sigmas.cwiseAbs2().asDiagonal();
}

/// The state that a request sets. Throws std::invalid_argument where it is none.
StateRequest stateOf(const SetState::Request& request) {
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  StateRequest state{stampOf(request.stamp), Eigen::Map<const Vector<6>>(request.state.data()), {}};
  Matrix<6>& P = state.covariance;
  if (request.covariance.size() == 36)
    P = Eigen::Map<const RowMajor>(request.covariance.data());
  else if (request.covariance.size() == 6)
    P = covarianceOf(Eigen::Map<const Vector<6>>(request.covariance.data()));
  else
    throw std::invalid_argument(fmt::format("covariance has {} numbers; give 36, row-major, or 6 standard deviations",
                                            request.covariance.size()));
  if (!state.state.allFinite() || state.state.cwiseAbs().maxCoeff() > 1e9)
    throw std::invalid_argument("state has a number that is not finite, or beyond 1e9");
  const double asymmetry = (P - P.transpose()).cwiseAbs().maxCoeff();
  if (!P.allFinite() || asymmetry > 1e-9 * P.cwiseAbs().maxCoeff() || P.llt().info() != Eigen::Success)
    throw std::invalid_argument("covariance is not symmetric and positive definite");
  return state;
}

template <class Response>
bool answer(Response& response, bool success, const std::string& message) {
  response.success = success;
  response.message = message;
  return true;
}

}  // namespace

void EstimatorServer::advertiseServices() {
  services_ = {own_.advertiseService("reset", &EstimatorServer::onReset, this),
               own_.advertiseService("set_datum", &EstimatorServer::onSetDatum, this),
               own_.advertiseService("set_state", &EstimatorServer::onSetState, this),
               own_.advertiseService("enable_sensor", &EstimatorServer::onEnableSensor, this),
               own_.advertiseService("get_state_at", &EstimatorServer::onGetStateAt, this)};
}

bool EstimatorServer::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  startAnew();
  return answer(response, true, "estimators start anew");
}

bool EstimatorServer::onSetDatum(SetDatum::Request& request, SetDatum::Response& response) {
  const Geodetic datum{request.latitude, request.longitude, request.altitude};
  try {
    const LocalFrame valid(datum);
  } catch (const std::invalid_argument& error) {
    return answer(response, false, error.what());
  }
  const bool anew = run_->session().positionsAreOfMap();
  system_->map.datum = datum;
  if (anew) startAnew();
  run_->setDatum(datum);
  if (batch_) batch_->take([datum](SystemRun& run) { run.setDatum(datum); });
  datum_published_ = false;
  publishDatum();
  return answer(response, true, anew ? "datum set, estimators start anew" : "datum set");
}

bool EstimatorServer::onSetState(SetState::Request& request, SetState::Response& response) {
  StateRequest state;
  try {
    state = stateOf(request);
  } catch (const std::invalid_argument& error) {
    return answer(response, false, error.what());
  }
  bool any = false;
  std::string refused;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (!request.estimator.empty() && request.estimator != lanes_[i].name) continue;
    any = true;
    const std::string reason = run_->session().setState(i, run_->frame(), state);
    if (!reason.empty()) refused += fmt::format("{}{}: {}", refused.empty() ? "" : "; ", lanes_[i].name, reason);
    if (reason.empty()) publishNow(i);
  }
  queueSettled();
  open_ = open_ || any;
  return answer(response, any && refused.empty(), any ? refused : "no such estimator");
}

bool EstimatorServer::onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response) {
  const auto& sources = run_->sources();
  std::vector<std::string> names;
  for (const auto& source : sources) names.push_back(source.name);
  const auto found = std::find(names.begin(), names.end(), request.sensor);
  if (found == names.end())
    return answer(response, false,
                  fmt::format("'{}' is no sensor; known are {}", request.sensor, fmt::join(names, ", ")));
  const auto enable = [source = static_cast<std::size_t>(found - names.begin()),
                       enabled = request.enabled != 0](SystemRun& run) { run.inbox().enable(source, enabled); };
  enable(*run_);
  if (batch_) batch_->take(enable);
  return answer(response, true, "");
}

bool EstimatorServer::onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response) {
  const auto found =
      request.estimator.empty() ? names_.begin() : std::find(names_.begin(), names_.end(), request.estimator);
  if (found == names_.end()) return answer(response, false, "no such estimator");
  const auto lane = static_cast<std::size_t>(found - names_.begin());
  const auto solution = run_->session().at(lane, run_->frame(), stampOf(request.stamp));
  if (!solution)
    return answer(response, false,
                  "the stamp is older than the lag or far ahead, or the estimator has not started or keeps no history");
  response.odometry = odometryOf(*solution, system_->map);
  if (solution->current) response.current = currentOf(*solution, system_->map);
  return answer(response, true, "");
}

}  // namespace sas_motion::ros_side
