// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/trajectory.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kNode = 0.25;  // [s]
const std::array<double, 3> kAbscissa{-0.7745966692414834, 0,
                                      0.7745966692414834};              // Gauss-Legendre of degree 5 on [-1, 1]
constexpr std::array<double, 3> kWeight{5.0 / 18, 8.0 / 18, 5.0 / 18};  // over the interval's length

/// The mean of a function over an interval.
template <class Function>
auto meanOver(double begin, double end, const Function& f) {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  auto sum = (kWeight[0] * f(middle + half * kAbscissa[0])).eval();
  for (std::size_t i = 1; i < 3; ++i) sum += kWeight[i] * f(middle + half * kAbscissa[i]);
  return sum;
}

/// Value, first and second derivative of a wave.
Vector<3> swing(const Wave& wave, double time) {
  const double w = 2 * kPi / wave.period, angle = w * time + wave.phase, s = std::sin(angle), c = std::cos(angle);
  return wave.amplitude * Vector<3>(s, w * c, -w * w * s);
}

double checked(const char* name, double value) {
  if (!(value > 0)) throw std::invalid_argument(fmt::format("{} is {} but must be positive", name, value));
  return value;
}

}  // namespace

Vector<3> TruthSample::rateBody() const {
  const Vector<3> nav =
      earth::rotationRate(state.latitude) + earth::transportRate(state.latitude, state.height, state.velocity_nav);
  return rate_nav_body + state.q_nav_body.conjugate() * nav;
}

Vector<3> TruthSample::forceBody() const {
  const Vector<3> rate =
      2 * earth::rotationRate(state.latitude) + earth::transportRate(state.latitude, state.height, state.velocity_nav);
  const Vector<3> up(0, 0, earth::gravity(state.latitude, state.height));
  return state.q_nav_body.conjugate() * (acceleration_nav + rate.cross(state.velocity_nav) + up);
}

Trajectory::Trajectory(const Track& track, double duration)
    : track_(track),
      line_time_(checked("line_length", track.line_length) / checked("speed", track.speed)),
      turn_time_(15.0 / 8 * kPi / checked("turn_rate", track.turn_rate)) {
  for (const Wave* wave : {&track.pitch, &track.roll, &track.yaw, &track.heave, &track.sway})
    checked("period", wave->period);
  nodes_.push_back(Vector<3>::Zero());
  for (double begin = 0; begin < duration + 1; begin = kNode * static_cast<double>(nodes_.size() - 1))
    nodes_.push_back(nodes_.back() + way(begin, begin + kNode));
}

Trajectory::Course Trajectory::course(double time) const {
  const double lap = line_time_ + turn_time_, count = std::floor(time / lap), within = time - count * lap - line_time_;
  const bool odd = std::fmod(count, 2) != 0;
  const double from = track_.heading + (odd ? kPi : 0), turn = odd ? -kPi : kPi;
  if (within <= 0) return {from, 0};
  const double s = within / turn_time_;
  return {from + turn * s * s * s * (10 - 15 * s + 6 * s * s), turn * 30 * s * s * (1 - s) * (1 - s) / turn_time_};
}

Trajectory::Direction Trajectory::direction(double time) const {
  const auto [angle, rate] = course(time);
  const Vector<3> none = Vector<3>::Zero(), yaw = track_.along_bow ? swing(track_.yaw, time) : none,
                  pitch = track_.along_bow ? swing(track_.pitch, time) : none;
  const double s = std::sin(angle + yaw(0)), c = std::cos(angle + yaw(0)), sp = std::sin(pitch(0)),
               cp = std::cos(pitch(0));
  return {{cp * s, cp * c, sp},
          (rate + yaw(1)) * Vector<3>(cp * c, -cp * s, 0) + pitch(1) * Vector<3>(-sp * s, -sp * c, cp)};
}

Vector<3> Trajectory::way(double begin, double end) const {
  return track_.speed * (end - begin) * meanOver(begin, end, [&](double time) { return direction(time).unit; });
}

TruthSample Trajectory::at(double time) const {
  const auto node = std::min(static_cast<std::size_t>(std::max(0.0, time) / kNode), nodes_.size() - 1);
  const auto [angle, rate] = course(time);
  const auto [unit, unit_rate] = direction(time);
  const Vector<3> sway = swing(track_.sway, time), heave = swing(track_.heave, time), yaw = swing(track_.yaw, time);
  const Vector<2> across(std::cos(track_.heading), -std::sin(track_.heading));
  const Vector<3> waved(nodes_[node] + way(kNode * static_cast<double>(node), time));
  const Vector<3> up(waved.z() + heave(0), track_.speed * unit.z() + heave(1), track_.speed * unit_rate.z() + heave(2));
  // East and north, with their derivatives, as if the Earth were flat at the start.
  const Vector<2> flat = waved.head<2>() + sway(0) * across;
  const Vector<2> flat_rate = track_.speed * unit.head<2>() + sway(1) * across;
  const Vector<2> flat_second = track_.speed * unit_rate.head<2>() + sway(2) * across;

  const double L0 = track_.start.latitude_deg * kRadPerDeg;
  const auto R0 = earth::radii(L0, track_.start.altitude);
  const double per_east = 1 / (R0.N * std::cos(L0)), per_north = 1 / R0.M;
  TruthSample truth;
  truth.course = angle;
  truth.turn_rate = rate;
  NavigationState& state = truth.state;
  state.latitude = L0 + per_north * flat.y();
  state.longitude = track_.start.longitude_deg * kRadPerDeg + per_east * flat.x();
  state.height = track_.start.altitude + up(0);

  const auto R = earth::radii(state.latitude, state.height), R_L = earth::radiiByLatitude(state.latitude);
  const double cL = std::cos(state.latitude), sL = std::sin(state.latitude);
  const double L1 = per_north * flat_rate.y(), L2 = per_north * flat_second.y(), lon1 = per_east * flat_rate.x(),
               lon2 = per_east * flat_second.x();
  state.velocity_nav << R.N * cL * lon1, R.M * L1, up(1);
  truth.acceleration_nav << (R_L.N * L1 + up(1)) * cL * lon1 - R.N * sL * L1 * lon1 + R.N * cL * lon2,
      (R_L.M * L1 + up(1)) * L1 + R.M * L2, up(2);

  const Vector<3> pitch = swing(track_.pitch, time), roll = swing(track_.roll, time);
  const double heading_rate = rate + yaw(1), sr = std::sin(roll(0)), cr = std::cos(roll(0)), sp = std::sin(pitch(0)),
               cp = std::cos(pitch(0));
  state.q_nav_body = Eigen::Quaterniond(rotationOf({pitch(0), roll(0), angle + yaw(0)}));
  truth.rate_nav_body << pitch(1) * cr + heading_rate * sr * cp, roll(1) - heading_rate * sp,
      pitch(1) * sr - heading_rate * cr * cp;  // (0.2)
  return truth;
}

ImuReading Trajectory::imu(double begin, double end) const {
  const auto both = [&](double time) {
    const TruthSample truth = at(time);
    return (Vector<6>() << truth.rateBody(), truth.forceBody()).finished();
  };
  const Vector<6> mean = meanOver(begin, end, both);
  return {stampFromSeconds(end), mean.head<3>(), mean.tail<3>()};
}

}  // namespace sas_motion::ins
