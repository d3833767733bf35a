// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/alignment.hpp"

#include <algorithm>
#include <cmath>

namespace sas_motion::ins {
namespace {

void refuse(const std::vector<Reading>& readings, std::vector<Event>& events) {
  for (const auto& reading : readings)
    if (const auto* aiding = std::get_if<Aiding>(&reading))
      events.push_back(refusal(*aiding, Verdict::Stale, "before the start"));
}

}  // namespace

void Alignment::take(const Reading& reading, std::vector<Event>& events) {
  if (started_) return pass(reading, events);
  gather(reading, events);
  const auto* aiding = std::get_if<Aiding>(&reading);
  if (!aiding || aiding->sensor != Sensor::Gps) return;
  const auto start = startAt(*aiding);
  if (!start) return;
  events.push_back(*start);
  for (const auto& later : since_) pass(later, events);
  since_.clear();
  started_ = true;
}

void Alignment::pass(const Reading& reading, std::vector<Event>& events) const {
  const auto* aiding = std::get_if<Aiding>(&reading);
  if (aiding && (options_.fixes_aid || aiding->sensor != Sensor::Gps)) events.push_back(*aiding);
  if (const auto* inertial = std::get_if<InertialReading>(&reading)) events.push_back(inertial->imu);
}

void Alignment::gather(const Reading& reading, std::vector<Event>& events) {
  if (const auto* aiding = std::get_if<Aiding>(&reading)) {
    if (aiding->lever_body) leverOf(parameters_, aiding->sensor) = *aiding->lever_body;
    if (aiding->sensor == Sensor::Dvl) velocity_ = *aiding;
    heard_fix_ |= aiding->sensor == Sensor::Gps;
  } else if (const auto* velocity = std::get_if<GroundVelocity>(&reading)) {
    ground_velocity_ = *velocity;
  } else {
    heard_unit_ = true;
    const auto& inertial = std::get<InertialReading>(reading);
    const bool old = attitude_ && secondsBetween(attitude_->imu.stamp, inertial.imu.stamp) > options_.max_age;
    if (inertial.attitude || old) {
      refuse(since_, events);
      since_.clear();
      attitude_ = inertial.attitude ? std::optional(inertial) : std::nullopt;
      return;
    }
  }
  if (attitude_)
    since_.push_back(reading);
  else
    refuse({reading}, events);
}

std::optional<Start> Alignment::startAt(const Aiding& fix) {
  if (!attitude_ || !fresh(attitude_->imu.stamp, fix)) return std::nullopt;
  if (!first_located_) first_located_ = fix.stamp;
  Start start{fix.fix, attitude_->imu.stamp, parameters_};
  NavigationState& state = start.state;
  state.q_nav_body = attitude_->attitude->q_nav_body;
  start.parameters.start_tilt = attitude_->attitude->tilt_sigma;
  start.parameters.start_heading = attitude_->attitude->heading_sigma;
  if (!setVelocity(fix, start)) return std::nullopt;
  displace(state, -(state.q_nav_body * parameters_.gps_lever_body) -
                      secondsBetween(start.stamp, fix.stamp) * state.velocity_nav);
  start.parameters.start_position =
      options_.fixes_aid ? Vector<3>::Constant(options_.position_sigma) : positionSigma(fix, start);
  return start;
}

/// Of the fix, its lever arm turned by an attitude that may be wrong, and the way since the start.
Vector<3> Alignment::positionSigma(const Aiding& fix, const Start& start) const {
  const Parameters& p = start.parameters;
  const Vector<3> lever = (start.state.q_nav_body * parameters_.gps_lever_body).cwiseAbs();
  const double across = lever.head<2>().norm(),
               horizontal = std::hypot(across * p.start_heading, lever.z() * p.start_tilt);
  const double moved = secondsBetween(start.stamp, fix.stamp) * p.start_velocity;
  const Vector<3> turned(horizontal, horizontal, across * p.start_tilt);
  const Vector<3> of_fix = fix.variance.value_or(parameters_.gps_white.cwiseAbs2());
  return (of_fix + turned.cwiseAbs2() + Vector<3>::Constant(moved * moved)).cwiseSqrt();
}

bool Alignment::setVelocity(const Aiding& fix, Start& start) const {
  Vector<3>& velocity_nav = start.state.velocity_nav;
  double& sigma = start.parameters.start_velocity;
  if (ground_velocity_ && fresh(ground_velocity_->stamp, fix)) {
    const Vector<3> turning_body =
        rateOverGround(start.state, attitude_->imu.rate_body).cross(parameters_.gps_lever_body);
    velocity_nav = ground_velocity_->velocity_nav - start.state.q_nav_body * turning_body;
    sigma = ground_velocity_->sigma;
  } else if (velocity_ && fresh(velocity_->stamp, fix)) {
    const ErrorModel model(parameters_, start.state);
    velocity_nav =
        start.state.q_nav_body * model.velocityOfIns(start.state, attitude_->imu.rate_body, velocity_->velocity_body);
    const double turned =
        velocity_nav.norm() * std::min(start.parameters.start_heading, 1.0);  // by an attitude that is wrong
    sigma = std::hypot(options_.velocity_sigma, turned);
  } else if (secondsBetween(*first_located_, fix.stamp) >= options_.velocity_wait) {
    velocity_nav.setZero();
    sigma = options_.rest_velocity_sigma;
  } else {
    return false;
  }
  return true;
}

Alignment::Lack Alignment::lack() const {
  if (started_) return Lack::Nothing;
  if (!heard_unit_) return Lack::InertialUnit;
  if (!attitude_) return Lack::Attitude;
  if (!heard_fix_) return Lack::Fix;
  return first_located_ ? Lack::Velocity : Lack::FixAfterAttitude;
}

}  // namespace sas_motion::ins
