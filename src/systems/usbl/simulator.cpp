// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/simulator.hpp"

#include <cmath>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::usbl {
namespace {

constexpr std::uint64_t kChannelStream = 10, kSpellStream = 20, kAttitudeStream = 30, kGnssStream = 31;
constexpr double kSteer = 0.05;  // [s] between changes of the course on the way to a waypoint

/// The pose on a circle that is sailed clockwise, or anticlockwise for a negative radius.
Pose onCircle(const Vector<2>& centre, double radius, double bearing_from_centre) {
  Pose pose;
  pose.position_map << centre(0) + std::abs(radius) * std::sin(bearing_from_centre),
      centre(1) + std::abs(radius) * std::cos(bearing_from_centre), 0;
  pose.attitude.heading = wrapAngle(bearing_from_centre + std::copysign(kPi / 2, radius));
  return pose;
}

/// The pose on two circles that touch in the centre, in turns; the first is sailed clockwise, to starboard of the
/// heading.
Pose onFigureEight(const Track& track, double distance) {
  const double round = 2 * kPi * track.radius, along = std::fmod(distance, 2 * round);
  const double side = along < round ? 1 : -1, angle = std::fmod(along, round) / track.radius;
  const double to_centre = track.heading + side * kPi / 2;
  const Vector<2> centre = track.centre + track.radius * Vector<2>(std::sin(to_centre), std::cos(to_centre));
  return onCircle(centre, side * track.radius, to_centre + kPi + side * angle);
}

}  // namespace

Vector<3> transponderFrom(const Geodetic& position, const Geodetic& transponder) {
  return LocalFrame(position).position_enu(transponder);
}

Vessel::Vessel(const Scenario& scenario) : scenario_(scenario) {
  const auto& waypoints = scenario.track.waypoints;
  if (scenario.track.kind != Track::Kind::Waypoints) return;
  pose_.position_map << waypoints[0], 0;
  const Vector<2> leg = waypoints[1] - waypoints[0];
  pose_.attitude.heading = std::atan2(leg(0), leg(1));
}

/// Steers towards the next waypoint within the turn rate; a waypoint is reached at 1.5 times the radius of a turn.
void Vessel::followWaypoints(double time) {
  const Track& track = scenario_.track;
  const double reached = 1.5 * track.speed / track.turn_rate;
  for (; sailed_ < time; sailed_ += kSteer) {
    const double dt = std::min(kSteer, time - sailed_);
    Vector<2> leg = track.waypoints[next_] - pose_.position_map.head<2>();
    if (leg.norm() < reached) {
      next_ = (next_ + 1) % track.waypoints.size();
      leg = track.waypoints[next_] - pose_.position_map.head<2>();
    }
    double& heading = pose_.attitude.heading;
    const double turn = wrapAngle(std::atan2(leg(0), leg(1)) - heading);
    heading = wrapAngle(heading + std::clamp(turn, -track.turn_rate * dt, track.turn_rate * dt));
    pose_.position_map.head<2>() += track.speed * dt * Vector<2>(std::sin(heading), std::cos(heading));
  }
  sailed_ = time;
}

Pose Vessel::at(double time) {
  const Track& track = scenario_.track;
  Pose pose;
  if (track.kind == Track::Kind::Circle) {
    pose = onCircle(track.centre, track.radius, track.heading + track.speed * time / track.radius);
  } else if (track.kind == Track::Kind::FigureEight) {
    pose = onFigureEight(track, track.speed * time);
  } else {
    followWaypoints(time);
    pose = pose_;
  }
  pose.attitude.roll = scenario_.wave_roll * std::sin(2 * kPi * time / scenario_.wave_period);
  pose.attitude.pitch = scenario_.wave_pitch * std::sin(2 * kPi * time / (0.8 * scenario_.wave_period) + 0.7);
  return pose;
}

Simulator::Simulator(const Scenario& scenario, std::uint64_t seed)
    : scenario_(scenario),
      frame_(scenario.datum),
      transponder_(frame_.geodetic(scenario.transponder_map)),
      attitude_noise_(seed, kAttitudeStream),
      gnss_noise_(seed, kGnssStream) {
  for (std::uint64_t i = 0; i < kChannels; ++i)
    channels_.emplace_back(scenario.noise[i], seed, kChannelStream + i, kSpellStream);
}

std::optional<LabelledPing> Simulator::ping(double time, const Pose& truth) {
  LabelledPing result;
  Ping& ping = result.ping;
  ping.stamp = kScenarioStart + stampFromSeconds(time);
  ping.C_body_map = rotationOf(truth.attitude).transpose();
  ping.transponder_map = transponderFrom(frame_.geodetic(truth.position_map), transponder_);
  const Vector<kChannels> sigma(scenario_.range_sigma, scenario_.direction_sigma, scenario_.direction_sigma);
  ping.reading.value = Model().predict(scenario_.truth, ping);
  ping.reading.variance = scenario_.stated_factor * sigma.cwiseAbs2();
  bool heard = false;
  for (int i = 0; i < kChannels; ++i) {
    const NoiseSample sample = channels_[i].draw(time);
    ping.reading.value(i) += sigma(i) * sample.value;
    result.outlier[i] = sample.outlier;
    result.variance(i) = sample.variance;
    if (sample.missing) ping.reading.variance(i) = std::numeric_limits<double>::quiet_NaN();
    heard |= !sample.missing;
  }
  if (!heard) return std::nullopt;
  return result;
}

Pose Simulator::measuredAttitude(const Pose& truth) {
  Pose measured = truth;
  measured.attitude.pitch += scenario_.attitude_sigma * attitude_noise_.gaussian();
  measured.attitude.roll += scenario_.attitude_sigma * attitude_noise_.gaussian();
  measured.attitude.heading =
      wrapAngle(measured.attitude.heading + scenario_.heading_sigma * attitude_noise_.gaussian());
  return measured;
}

Vector<3> Simulator::measuredAntenna(const Pose& truth) {
  const Vector<3> noise(gnss_noise_.gaussian(), gnss_noise_.gaussian(), gnss_noise_.gaussian());
  return truth.position_map + rotationOf(truth.attitude) * scenario_.gnss_lever_arm_body +
         noise.cwiseProduct(Vector<3>(scenario_.gnss_sigma, scenario_.gnss_sigma, scenario_.gnss_sigma_up));
}

std::vector<LabelledPing> simulatePings(const Scenario& scenario, std::uint64_t seed) {
  Simulator simulator(scenario, seed);
  Vessel vessel(scenario);
  std::vector<LabelledPing> pings;
  for (long k = 1; static_cast<double>(k) / scenario.ping_rate <= scenario.duration + 1e-9; ++k) {
    const double time = static_cast<double>(k) / scenario.ping_rate;
    const Pose truth = vessel.at(time);
    auto labelled = simulator.ping(time, truth);
    const Pose measured = simulator.measuredAttitude(truth);
    const Matrix<3> C_map_body = rotationOf(measured.attitude);
    const Vector<3> reference = simulator.measuredAntenna(truth) - C_map_body * scenario.gnss_lever_arm_body;
    if (!labelled) continue;
    labelled->ping.C_body_map = C_map_body.transpose();
    labelled->ping.transponder_map = transponderFrom(simulator.frame().geodetic(reference), simulator.transponder());
    pings.push_back(*labelled);
  }
  return pings;
}

}  // namespace sas_motion::usbl
