// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/ins_alignment.hpp"

namespace sas_motion::ins {
namespace {

Event eventOf(const Reading& reading) {
  if (const auto* aiding = std::get_if<Aiding>(&reading)) return *aiding;
  return std::get<InertialReading>(reading).imu;
}

void refuse(const std::vector<Reading>& readings, std::vector<Event>& events) {
  for (const auto& reading : readings)
    if (const auto* aiding = std::get_if<Aiding>(&reading)) events.push_back(refusal(*aiding, Verdict::Stale, "before the start"));
}

}  // namespace

Audit refusal(const Aiding& reading, Verdict verdict, const char* reason) {
  Audit audit{reading.stamp, reading.sensor, verdict};
  audit.weights.setZero();
  audit.reason = reason;
  return audit;
}

void Alignment::take(const Reading& reading, std::vector<Event>& events) {
  if (started_) {
    events.push_back(eventOf(reading));
    return;
  }
  gather(reading, events);
  const auto* aiding = std::get_if<Aiding>(&reading);
  if (!aiding || aiding->sensor != Sensor::Gps) return;
  const auto start = startAt(*aiding);
  if (!start) return;
  events.push_back(*start);
  for (const auto& later : since_) events.push_back(eventOf(later));
  since_.clear();
  started_ = true;
}

void Alignment::gather(const Reading& reading, std::vector<Event>& events) {
  if (const auto* aiding = std::get_if<Aiding>(&reading)) {
    if (aiding->lever_body) leverOf(parameters_, aiding->sensor) = *aiding->lever_body;
    if (aiding->sensor == Sensor::Dvl) velocity_ = *aiding;
    heard_fix_ |= aiding->sensor == Sensor::Gps;
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
  const auto fresh = [&](Stamp stamp) { return secondsBetween(stamp, fix.stamp) <= options_.max_age; };
  if (!attitude_ || !fresh(attitude_->imu.stamp)) return std::nullopt;
  if (!first_located_) first_located_ = fix.stamp;
  const bool moves = velocity_ && fresh(velocity_->stamp);
  if (!moves && secondsBetween(*first_located_, fix.stamp) < options_.velocity_wait) return std::nullopt;

  Start start{fix.fix, attitude_->imu.stamp, parameters_};
  NavigationState& state = start.state;
  state.q_nav_body = attitude_->attitude->q_nav_body;
  state.velocity_nav = moves ? velocity(start) : Vector<3>::Zero();
  displace(state, -(state.q_nav_body * parameters_.gps_lever_body) - secondsBetween(start.stamp, fix.stamp) * state.velocity_nav);
  start.parameters.start_position.setConstant(options_.position_sigma);
  start.parameters.start_velocity = moves ? options_.velocity_sigma : options_.rest_velocity_sigma;
  start.parameters.start_tilt = attitude_->attitude->tilt_sigma;
  start.parameters.start_heading = attitude_->attitude->heading_sigma;
  return start;
}

Vector<3> Alignment::velocity(const Start& start) const {
  const ErrorModel model(parameters_, start.state);
  return start.state.q_nav_body * model.velocityOfIns(start.state, attitude_->imu.rate_body, velocity_->velocity_body);
}

Alignment::Lack Alignment::lack() const {
  if (started_) return Lack::Nothing;
  if (!heard_unit_) return Lack::InertialUnit;
  if (!attitude_) return Lack::Attitude;
  if (!heard_fix_) return Lack::Fix;
  return first_located_ ? Lack::Velocity : Lack::FixAfterAttitude;
}

}  // namespace sas_motion::ins
