// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "imaging/micronavigation_steps.hpp"
#include "sas_motion/imaging/interpolator.hpp"

namespace sas_motion::imaging {
PingPair::PingPair(const SonarDescription& sonar, const PingPose& first, const PingPose& second,
                   const MicronavigationOptions& options)
    : poses{first, second},
      bottom(options.bottom),
      paths(echoPaths(sonar, {first, second})),
      sound_speed(sonar.sound_speed) {
  C_local_body =
      Eigen::Quaterniond(first.C_local_body).slerp(0.5, Eigen::Quaterniond(second.C_local_body)).toRotationMatrix();
  forward = C_local_body.col(0);
  down = (forward.z() * forward - Eigen::Vector3d::UnitZ()).normalized();
  across = options.starboard ? Eigen::Vector3d(down.cross(forward)) : Eigen::Vector3d(forward.cross(down));
  origin.setZero();
  for (const auto& path : paths) origin += path.phaseCentre() / static_cast<double>(paths.size());
}

Eigen::Vector3d PingPair::sight(double range, double along, double sine) const {
  const double cosine = std::sqrt(1 - sine * sine);
  const double height = origin.z() + (along + range * sine) * forward.z() - bottom;
  // sine of the depression angle in the plane across the track
  const double depression = std::clamp(height / (-down.z() * range * cosine), 0.0, 1.0);
  return sine * forward + cosine * (std::sqrt(1 - depression * depression) * across + depression * down);
}

double PingPair::along(std::size_t channel, double range) const {
  const EchoPath& path = paths[channel];
  return forward.dot(path.phaseCentre() + path.receiver_velocity * range / sound_speed - origin);
}

Eigen::Vector3d PingPair::displacement(double range) const {
  const std::size_t receivers = paths.size() / 2;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < receivers; ++i)
    sum += paths[receivers + i].phaseCentre() - paths[i].phaseCentre() +
           (paths[receivers + i].receiver_velocity - paths[i].receiver_velocity) * range / sound_speed;
  sum /= static_cast<double>(receivers);
  return {forward.dot(sum), across.dot(sum), down.dot(sum)};
}

double PingPair::halfPath(std::size_t channel, double range, double sine) const {
  const double place = along(channel, range);
  return pathLength(paths[channel], origin + place * forward + range * sight(range, place, sine), sound_speed) / 2;
}

PingPair::PathShape PingPair::shape(std::size_t channel, double range, double sine) const {
  const double aft = halfPath(channel, range, -sine), middle = halfPath(channel, range, 0),
               fore = halfPath(channel, range, sine);
  return {(fore - aft) / (2 * sine), (0.5 * (fore + aft) - middle) / (sine * sine)};
}

AlignedLines align(const EchoLines& lines, std::size_t first_line, const SonarDescription& sonar,
                   const PingPair& pair) {
  AlignedLines aligned;
  aligned.range_step = lines.sound_speed / lines.sample_rate / 2;
  aligned.first_range = sonar.near_range;
  aligned.samples = static_cast<int>((sonar.far_range - sonar.near_range) / aligned.range_step);
  aligned.channels.assign(pair.paths.size(), std::vector<Complex>(static_cast<std::size_t>(aligned.samples)));
  const Interpolator interpolator;
  for (std::size_t channel = 0; channel < pair.paths.size(); ++channel)
    for (int n = 0; n < aligned.samples; ++n) {
      const double length = 2 * pair.halfPath(channel, aligned.range(n), 0);
      const double turns = lines.carrier / lines.sound_speed * length;
      aligned.channels[channel][static_cast<std::size_t>(n)] =
          interpolator.at(lines.line(first_line + channel), lines.samples, lines.position(length)) *
          std::polar(1.0, 2 * kPi * (turns - std::floor(turns)));
    }
  return aligned;
}

}  // namespace sas_motion::imaging
