// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/session.hpp"

#include <cmath>

#include "sas_motion/navigation/attitude.hpp"

namespace sas_motion::ins {
namespace {

Geodetic placeOf(const NavigationState& state) {
  return {state.latitude / kRadPerDeg, state.longitude / kRadPerDeg, state.height};
}

/// The start that a user sets: position, heading and horizontal velocity are the request's, height and tilt those of
/// the solution at its stamp.
Start startOf(const NavigationSolution& solution, const OutputFrame& frame, const StateRequest& request,
              const Parameters& parameters) {
  const Vector<6>& x = request.state;
  const auto sigma = [&](int i) { return std::sqrt(request.covariance(i, i)); };
  Start start{movedBy(solution, frame.base_lever_body).state, solution.stamp, parameters};
  NavigationState& state = start.state;
  const Vector<3> forward = state.q_nav_body * Vector<3>::UnitY();
  const double turned = wrapAngle(x(4) - std::atan2(forward.y(), forward.x()));
  state.q_nav_body = Eigen::AngleAxisd(turned, Vector<3>::UnitZ()) * state.q_nav_body;
  state.velocity_nav.head<2>() = x.segment<2>(2) + x(5) * Vector<2>(std::cos(x(4)), std::sin(x(4)));
  const double height_map = frame.map->position_enu(placeOf(state)).z();
  const Geodetic place = frame.map->geodetic({x(0), x(1), height_map});
  state.latitude = place.latitude_deg * kRadPerDeg;
  state.longitude = place.longitude_deg * kRadPerDeg;
  displace(state, -(state.q_nav_body * frame.base_lever_body));

  Parameters& p = start.parameters;
  p.start_position.head<2>() << sigma(0), sigma(1);
  p.start_heading = sigma(4);
  p.start_velocity = std::hypot(sigma(5), std::max(sigma(2), sigma(3)));
  if (solution.covariance) {
    const Vector<9> variance = solution.covariance->diagonal();
    p.start_position.z() = std::sqrt(variance(kPosition + 2));
    p.start_tilt = std::sqrt(variance.segment<2>(kAttitude).maxCoeff());
  }
  return start;
}

}  // namespace

Solution solutionOf(const NavigationSolution& base, const LocalFrame& map) {
  const NavigationState& state = base.state;
  const Geodetic place = placeOf(state);
  const Matrix<3> C_map_nav = map.C_map_nav(place), C_map_body = C_map_nav * state.q_nav_body.toRotationMatrix();
  const Matrix<3> C_base_body = bodyFromRosBody().transpose(),
                  C_base_nav = C_base_body * state.q_nav_body.conjugate().toRotationMatrix();
  Solution solution;
  solution.stamp = base.stamp;
  solution.position_map = map.position_enu(place);
  solution.place = place;
  solution.q_map_base = Eigen::Quaterniond(C_map_body * bodyFromRosBody());
  if (base.has_velocity) solution.velocity_base = C_base_nav * state.velocity_nav;
  if (base.rate_body) solution.rate_base = C_base_body * *base.rate_body;
  auto &pose = solution.pose_covariance, &twist = solution.twist_covariance;
  if (base.covariance) {
    Matrix<6, 9> J = Matrix<6, 9>::Zero();  // of position and rotation in map
    J.block<3, 3>(0, kPosition) = C_map_nav;
    J.block<3, 3>(3, kAttitude) = -C_map_nav;
    pose = J * *base.covariance * J.transpose();
    Matrix<3, 9> V = Matrix<3, 9>::Zero();  // of the velocity in the base: C'^T v' = C^T (v - v x phi)
    V.block<3, 3>(0, kVelocity) = C_base_nav;
    V.block<3, 3>(0, kAttitude) = -C_base_nav * skew(state.velocity_nav);
    twist.topLeftCorner<3, 3>() = V * *base.covariance * V.transpose();
    solution.place_covariance = base.covariance->block<3, 3>(kPosition, kPosition);
  }
  if (!base.has_attitude) pose.diagonal().tail<3>().setConstant(kNotEstimated);
  if (!base.has_velocity) twist.diagonal().head<3>().setConstant(kNotEstimated);
  if (!base.rate_body) twist.diagonal().tail<3>().setConstant(kNotEstimated);
  return solution;
}

NavigationSession::NavigationSession(const SessionOptions& options, const std::vector<std::string>& names,
                                     const EstimatorFactory& make, double output_rate, bool live)
    : SessionOf(
          options.config, options.max_gap, names,
          [this, make, options = options](const std::string& name) mutable {
            options.config = config();
            return make(name, config()) ? std::make_unique<AlignedEstimator>(options, name, make) : nullptr;
          },
          live),
      output_rate_(output_rate),
      settled_rates_(names.size(), OutputRate(output_rate)) {}

void NavigationSession::reset() {
  SessionOf::reset();
  settled_rates_.assign(names().size(), OutputRate(output_rate_));
}

LaneReport NavigationSession::report(std::size_t lane) const {
  LaneReport report = SessionOf::report(lane);
  report.measurements = estimator(lane).measurements();
  return report;
}

std::optional<Solution> NavigationSession::solution(const NavigationSolution& solution,
                                                    const OutputFrame& frame) const {
  if (!frame.map) return std::nullopt;
  return solutionOf(movedBy(solution, frame.base_lever_body), *frame.map);
}

std::optional<Solution> NavigationSession::settledSolution(std::size_t lane, const NavigationSolution& state,
                                                           const OutputFrame& frame) {
  return settled_rates_[lane].due(state.stamp) ? solution(state, frame) : std::nullopt;
}

std::string NavigationSession::setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) {
  if (!frame.map) return "the datum of the map is not known yet";
  const auto solution = request.stamp == 0 ? timeline(lane).current() : timeline(lane).at(request.stamp);
  if (!solution)
    return "the stamp is older than the lag or far ahead, or the estimator has not started or keeps no present state; "
           "height and tilt at the stamp come from it";
  return setStart(lane, startOf(*solution, frame, request, config().parameters));
}

}  // namespace sas_motion::ins
