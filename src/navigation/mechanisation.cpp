// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/mechanisation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"

namespace sas_motion {
namespace {

double checked(const char* name, double value) {
  if (!(value > 0)) throw std::invalid_argument(fmt::format("{} is {} but must be positive", name, value));
  return value;
}

}  // namespace

Vector<3> displacement(const NavigationState& origin, const NavigationState& point) {
  const auto [M, N] = earth::radii(origin.latitude, origin.height);
  return {N * std::cos(origin.latitude) * wrapAngle(point.longitude - origin.longitude),
          M * (point.latitude - origin.latitude), point.height - origin.height};
}

void displace(NavigationState& state, const Vector<3>& metres_nav) {
  const auto [M, N] = earth::radii(state.latitude, state.height);
  state.longitude = wrapAngle(state.longitude + metres_nav.x() / (N * std::cos(state.latitude)));
  state.latitude += metres_nav.y() / M;
  state.height += metres_nav.z();
}

Vector<3> attitudeError(const Eigen::Quaterniond& computed, const Eigen::Quaterniond& truth) {
  Eigen::Quaterniond turn = computed * truth.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  return -turn.vec() * (sine < 1e-9 ? 2 : 2 * std::atan2(sine, turn.w()) / sine);
}

Mechanisation::Mechanisation(const NavigationState& start, Stamp stamp, const Options& options)
    : options_(options), state_(start), stamp_(stamp) {
  checked("period", options.period);
  checked("longest_gap", options.longest_gap);
  checked("max_rate", options.max_rate);
  checked("max_force", options.max_force);
}

ImuVerdict Mechanisation::judge(const ImuReading& reading) const {
  const bool plausible = reading.rate_body.cwiseAbs().maxCoeff() <= options_.max_rate &&
                         reading.force_body.cwiseAbs().maxCoeff() <= options_.max_force;
  if (!plausible || !reading.rate_body.allFinite() || !reading.force_body.allFinite()) return ImuVerdict::Implausible;
  if (!started_ && reading.stamp == stamp_) return ImuVerdict::Started;
  if (reading.stamp <= stamp_) return ImuVerdict::OutOfOrder;
  const double dt = secondsBetween(stamp_, reading.stamp);
  if (dt > options_.longest_gap) return ImuVerdict::Bridged;
  return std::abs(dt - options_.period) > 0.5 * options_.period ? ImuVerdict::OffRate : ImuVerdict::Integrated;
}

ImuStep Mechanisation::step(const ImuReading& reading) {
  const ImuStep result{judge(reading), secondsBetween(stamp_, reading.stamp)};
  if (result.verdict == ImuVerdict::Implausible || result.verdict == ImuVerdict::OutOfOrder) return {result.verdict, 0};
  advance(reading, reading.stamp);
  return result;
}

void Mechanisation::advance(const ImuReading& reading, Stamp stamp) {
  const double dt = secondsBetween(stamp_, stamp);
  started_ = true;
  if (!(dt > 0)) return;
  const Vector<3> angle = reading.rate_body * dt, velocity = reading.force_body * dt;
  // Increments of the last interval, as if it had been as long as this one.
  const double scale = last_dt_ > 0 ? dt / last_dt_ : 0;
  const Vector<3> before_angle = scale * last_angle_, before_velocity = scale * last_velocity_;
  const Vector<3> rotation = angle + before_angle.cross(angle) / 12;
  const Vector<3> velocity_start = velocity + 0.5 * angle.cross(velocity) + angle.cross(angle.cross(velocity)) / 6 +
                                   (before_angle.cross(velocity) + before_velocity.cross(angle)) / 12;

  const double L = state_.latitude, h = state_.height;
  const Vector<3> v = state_.velocity_nav;
  const Vector<3> turn = (earth::rotationRate(L) + earth::transportRate(L, h, v)) * dt;  // of the nav frame
  const Vector<3> in_start = state_.q_nav_body * velocity_start;
  const Vector<3> velocity_nav = in_start - 0.5 * turn.cross(in_start);
  // Gravity and Coriolis at the middle of the interval.
  const auto [M, N] = earth::radii(L, h);
  const auto pull = [&](double latitude, double height, const Vector<3>& mean_v) -> Vector<3> {
    const Vector<3> rate = 2 * earth::rotationRate(latitude) + earth::transportRate(latitude, height, mean_v);
    return Vector<3>(0, 0, -earth::gravity(latitude, height)) - rate.cross(mean_v);
  };
  const Vector<3> middle_v = v + 0.5 * (velocity_nav + dt * pull(L, h, v));
  const double middle_L = L + 0.25 * dt * (v.y() + middle_v.y()) / M, middle_h = h + 0.25 * dt * (v.z() + middle_v.z());
  state_.velocity_nav = v + velocity_nav + dt * pull(middle_L, middle_h, middle_v);

  const Vector<3> mean_v = 0.5 * (v + state_.velocity_nav);
  const auto R = earth::radii(middle_L, middle_h);
  state_.latitude = L + dt * mean_v.y() / R.M;
  state_.longitude = wrapAngle(state_.longitude + dt * mean_v.x() / (R.N * std::cos(middle_L)));
  state_.height = h + dt * mean_v.z();
  const Vector<3> nav_turn = (earth::rotationRate(middle_L) + earth::transportRate(middle_L, middle_h, mean_v)) * dt;
  state_.q_nav_body = quaternionOf(-nav_turn) * state_.q_nav_body * quaternionOf(rotation);
  state_.q_nav_body.normalize();

  force_nav_ = velocity_nav / dt;
  const Vector<3> last_rate = last_dt_ > 0 ? Vector<3>(last_angle_ / last_dt_) : reading.rate_body;
  rate_body_ = reading.rate_body +
               dt / (dt + last_dt_) * (reading.rate_body - last_rate);  // from the middle of the interval to its end
  last_angle_ = angle;
  last_velocity_ = velocity;
  last_dt_ = dt;
  stamp_ = stamp;
}

}  // namespace sas_motion
