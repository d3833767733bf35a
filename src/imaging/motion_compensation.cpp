// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/motion_compensation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "sas_motion/imaging/interpolator.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

/// A line's deviation from the ideal track at transmission, and its rate until the echo arrives.
struct Deviation {
  double sway = 0, sway_rate = 0;    ///< of the phase centre, away from the target [m], [m/s]
  double heave = 0, heave_rate = 0;  ///< upwards [m], [m/s]
  double height = 0;                 ///< of the ideal track over the bottom [m]

  /// Error of the slant range of a target at this ideal range, whose echo takes `delay` [m].
  double slantError(double range, double delay) const {
    const double ground = std::sqrt(std::max(0.0, range * range - height * height));
    return (ground * (sway + sway_rate * delay) + height * (heave + heave_rate * delay)) / range;
  }
};

/// The line as from the ideal track.
void compensateLine(const EchoLines& lines, std::size_t i, const Deviation& deviation, double bandwidth,
                    const Interpolator& interpolator, std::complex<float>* result) {
  const double smallest_shift = lines.sound_speed / (2 * bandwidth) / 4;
  for (int n = 0; n < lines.samples; ++n) {
    const double delay = lines.first_delay + n / lines.sample_rate, range = lines.sound_speed / 2 * delay;
    const double error = range > 0 ? deviation.slantError(range, delay) : 0;
    const double shift = std::abs(error) > smallest_shift ? 2 * error / lines.sound_speed * lines.sample_rate : 0;
    const std::complex<double> echo =
        shift != 0 ? interpolator.at(lines.line(i), lines.samples, n + shift) : std::complex<double>(lines.line(i)[n]);
    result[n] = std::complex<float>(echo * std::polar(1.0, 4 * kPi * lines.carrier / lines.sound_speed * error));
  }
}

}  // namespace

StraightTrack fitTrack(const EchoLines& lines) {
  if (lines.paths.size() < 2) throw std::invalid_argument("fitTrack: a track takes at least two lines");
  StraightTrack track;
  for (const auto& path : lines.paths) track.origin += path.phaseCentre() / static_cast<double>(lines.paths.size());
  double xx = 0, xy = 0, yy = 0;
  for (const auto& path : lines.paths) {
    const Eigen::Vector3d way = path.phaseCentre() - track.origin;
    xx += way.x() * way.x();
    xy += way.x() * way.y();
    yy += way.y() * way.y();
  }
  if (!(xx + yy > 0)) throw std::invalid_argument("fitTrack: the track has no length");
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);  // of the principal axis
  track.direction = {std::cos(angle), std::sin(angle), 0};
  if (track.direction.dot(lines.paths.back().phaseCentre() - lines.paths.front().phaseCentre()) < 0)
    track.direction = -track.direction;
  return track;
}

EchoLines compensateMotion(const EchoLines& lines, const StraightTrack& track, double bandwidth,
                           const CompensationOptions& options) {
  EchoLines compensated = lines;
  const Eigen::Vector3d port = Eigen::Vector3d::UnitZ().cross(track.direction),
                        look = options.starboard ? Eigen::Vector3d(-port) : port;
  const Interpolator interpolator;
  forEachTask(lines.paths.size(), options.threads, [&](std::size_t i) {
    const Eigen::Vector3d way = lines.paths[i].phaseCentre() - track.origin;
    EchoPath& path = compensated.paths[i];
    const Eigen::Vector3d rate = path.receiver_velocity / 2;  // only the receiver moves after transmission
    const Deviation deviation{-way.dot(look), -rate.dot(look), way.z(), rate.z(), track.origin.z() - options.bottom};
    compensateLine(lines, i, deviation, bandwidth, interpolator, compensated.line(i));
    path.transmitter = path.receiver = track.origin + way.dot(track.direction) * track.direction;
    path.receiver_velocity = path.receiver_velocity.dot(track.direction) * track.direction;
    path.forward = track.direction;
  });
  return compensated;
}

}  // namespace sas_motion::imaging
