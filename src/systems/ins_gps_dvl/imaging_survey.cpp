// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/imaging_survey.hpp"

#include <algorithm>
#include <cmath>

namespace sas_motion::ins {

using namespace imaging;

namespace {

constexpr double kStartEvery = 1;  // [s]

Geodetic geodeticOf(const NavigationState& state) {
  return {state.latitude / kRadPerDeg, state.longitude / kRadPerDeg, state.height};
}

bool isStraight(const Trajectory& trajectory, double begin, double end) {
  for (double time = begin; time < end; time += kStartEvery)
    if (trajectory.at(time).turn_rate != 0) return false;
  return trajectory.at(end).turn_rate == 0;
}

/// The true poses themselves, not what lies between those of a trajectory.
std::vector<PingPose> truePoses(const Aperture& aperture, const Trajectory& trajectory) {
  std::vector<PingPose> poses;
  for (const Stamp ping : aperture.pings) {
    const double time = secondsBetween(0, ping);
    const TimedPose now = poseIn(aperture.map, ping, trajectory.at(time).state),
                    later = poseIn(aperture.map, ping, trajectory.at(time + aperture.interval).state);
    poses.push_back(
        {now.position, now.q_local_body.toRotationMatrix(), (later.position - now.position) / aperture.interval});
  }
  return poses;
}

Aperture apertureAt(double start, double duration, const Trajectory& trajectory, const FocusSettings& settings) {
  const SonarDescription& sonar = settings.sonar;
  const LocalFrame map(geodeticOf(trajectory.at(start + duration / 2).state));
  const auto place = [&](double time) { return map.position_enu(geodeticOf(trajectory.at(time).state)); };
  const double speed = (place(start + duration) - place(start)).head<2>().norm() / duration;
  const double ping_rate = settings.aperture.speed_locked ? neededPingRate(sonar, speed) : sonar.ping_rate;
  Aperture aperture{start, pingStamps(stampFromSeconds(start), duration, ping_rate), {}, echoTime(sonar), map, {}, {}};
  for (const Stamp ping : aperture.pings) aperture.times.push_back(secondsBetween(aperture.pings.front(), ping));
  const auto truth = truePoses(aperture, trajectory);
  aperture.frame = apertureFrame(truth, sonar.altitude);
  aperture.truth = aperturePoses(truth, aperture.frame, sonar.altitude);
  return aperture;
}

}  // namespace

std::vector<Aperture> chooseApertures(const Scenario& scenario, const Trajectory& trajectory,
                                      const FocusSettings& settings, double skip, int count) {
  const double duration =
      settings.aperture.duration > 0 ? settings.aperture.duration : apertureTime(settings, scenario.track.speed);
  const double needed =
      duration + echoTime(settings.sonar) + settings.aperture.longest_gap;  // with solutions before and behind
  std::vector<double> starts;
  for (double start = skip; start + needed <= scenario.duration; start += kStartEvery)
    if (isStraight(trajectory, start, start + needed)) starts.push_back(start);
  std::vector<Aperture> apertures;
  for (int i = 0; i < count && !starts.empty(); ++i)
    apertures.push_back(
        apertureAt(starts[static_cast<std::size_t>((i + 0.5) / count * static_cast<double>(starts.size()))], duration,
                   trajectory, settings));
  return apertures;
}

void ApertureTrack::add(Stamp stamp, const NavigationState& state) {
  if (secondsBetween(stamp, aperture_->pings.front()) > longest_gap_) return;
  if (secondsBetween(aperture_->pings.back(), stamp) > aperture_->interval + longest_gap_) return;
  poses_map_.push_back(poseIn(aperture_->map, stamp, state));
}

std::optional<std::vector<PingPose>> ApertureTrack::poses(double altitude) const {
  const imaging::Trajectory gathered = trajectory();
  const Stamp end = aperture_->pings.back() + stampFromSeconds(aperture_->interval);
  if (gathered.firstGap(aperture_->pings.front(), end, longest_gap_)) return std::nullopt;
  return aperturePoses(pingPoses(gathered, aperture_->pings, aperture_->interval), aperture_->frame, altitude);
}

}  // namespace sas_motion::ins
