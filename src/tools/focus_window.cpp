// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/focus_steps.hpp"

namespace sas_motion {

using namespace imaging;

namespace {

constexpr double kStandstill = 0.01;  // m/s

/// Truth over the time that all trajectories have in common.
Trajectory commonTruth(const std::vector<RecordedTrajectory>& trajectories) {
  const auto& truth = trajectories.front().trajectory.poses();
  Stamp begin = truth.front().stamp, end = truth.back().stamp;
  for (const auto& t : trajectories)
    if (!t.trajectory.poses().empty()) {
      begin = std::max(begin, t.trajectory.poses().front().stamp);
      end = std::min(end, t.trajectory.poses().back().stamp);
    }
  std::vector<TimedPose> poses;
  std::copy_if(truth.begin(), truth.end(), std::back_inserter(poses),
               [&](const TimedPose& pose) { return pose.stamp >= begin && pose.stamp <= end; });
  return Trajectory(std::move(poses));
}

/// Begin of the window; it and the last echo are inside the bag.
Stamp chooseBegin(const std::string& bag, const std::vector<RecordedTrajectory>& trajectories,
                  const FocusSettings& settings, double duration) {
  const auto& truth = trajectories.front().trajectory.poses();
  const double needed = duration + echoTime(settings.sonar),
               there = secondsBetween(truth.front().stamp, truth.back().stamp);
  if (settings.aperture.start) {
    if (*settings.aperture.start + needed > there)
      throw std::runtime_error(
          fmt::format("{}: aperture.start is {} and the window takes {:.4g} s but the bag's truth is {:.4g} s long; "
                      "start earlier or set a shorter aperture.duration",
                      bag, *settings.aperture.start, needed, there));
    return truth.front().stamp + stampFromSeconds(*settings.aperture.start);
  }
  const auto begin = straightestWindow(commonTruth(trajectories), needed, settings.aperture.longest_gap);
  if (!begin)
    throw std::runtime_error(
        fmt::format("{}: no stretch of {:.4g} s that all trajectories reach over, of {:.4g} s of truth, has poses at "
                    "most aperture.longest_gap, {} s, apart; set a shorter aperture.duration or a longer gap",
                    bag, needed, there, settings.aperture.longest_gap));
  return *begin;
}

void requireCover(const std::string& bag, const RecordedTrajectory& t, Stamp begin, Stamp end, Stamp zero,
                  double longest) {
  if (const auto gap = t.trajectory.firstGap(begin, end, longest))
    throw std::runtime_error(
        fmt::format("{}: {} has no poses from {:.3f} s to {:.3f} s after the first truth, in the window from {:.3f} s "
                    "to {:.3f} s; set another aperture.start or leave it out with --trajectory",
                    bag, t.topic, secondsBetween(zero, gap->begin), secondsBetween(zero, gap->end),
                    secondsBetween(zero, begin), secondsBetween(zero, end)));
}

/// The ping rate that samples the aperture at this speed.
double choosePingRate(const std::string& bag, const FocusSettings& settings, double speed) {
  const SonarDescription& sonar = settings.sonar;
  const double needed = neededPingRate(sonar, speed);
  if (speed < kStandstill)
    throw std::runtime_error(fmt::format(
        "{}: the truth moves at {:.2g} m/s in the window, which makes no aperture; set another aperture.start", bag,
        speed));
  if (needed > sonar.ping_rate)
    throw std::runtime_error(
        fmt::format("{}: the sonar's ping_rate is {} but must be at least {:.4g} to sample the aperture at the "
                    "window's speed of {:.4g} m/s",
                    bag, sonar.ping_rate, needed, speed));
  return settings.aperture.speed_locked ? needed : sonar.ping_rate;
}

double speedIn(const Trajectory& truth, Stamp begin, Stamp end) {
  return (truth.at(end)->position - truth.at(begin)->position).head<2>().norm() / secondsBetween(begin, end);
}

}  // namespace

FocusPings choosePings(const std::string& bag, const std::vector<RecordedTrajectory>& trajectories,
                       const FocusSettings& settings) {
  const RecordedTrajectory& truth = trajectories.front();
  const double mean_speed = meanSpeed(truth.trajectory);
  if (mean_speed < kStandstill)
    throw std::runtime_error(fmt::format("{}: {} does not move, which makes no aperture", bag, truth.topic));
  FocusPings pings;
  FocusWindow& window = pings.window;
  window.duration = settings.aperture.duration > 0 ? settings.aperture.duration : apertureTime(settings, mean_speed);
  const Stamp zero = truth.trajectory.poses().front().stamp,
              begin = chooseBegin(bag, trajectories, settings, window.duration);
  const Stamp end = begin + stampFromSeconds(window.duration);
  for (const auto& t : trajectories)
    requireCover(bag, t, begin, end + stampFromSeconds(echoTime(settings.sonar)), zero, settings.aperture.longest_gap);
  window.start = secondsBetween(zero, begin);
  window.speed = speedIn(truth.trajectory, begin, end);
  window.ping_rate = choosePingRate(bag, settings, window.speed);
  const auto stamps = pingStamps(begin, window.duration, window.ping_rate);
  window.pings = stamps.size();
  if (window.pings < 2)
    throw std::runtime_error(
        fmt::format("{}: a window of {:.4g} s holds one ping at {:.4g} Hz; set a longer aperture.duration", bag,
                    window.duration, window.ping_rate));
  for (const Stamp stamp : stamps) pings.times.push_back(secondsBetween(begin, stamp));
  const double interval = echoTime(settings.sonar), altitude = settings.sonar.altitude;
  window.frame = apertureFrame(pingPoses(truth.trajectory, stamps, interval), altitude);
  for (const auto& t : trajectories)
    pings.poses.push_back(aperturePoses(pingPoses(t.trajectory, stamps, interval), window.frame, altitude));
  return pings;
}

}  // namespace sas_motion
