// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sas_motion::imaging {
namespace {

bool isEarlier(const TimedPose& a, const TimedPose& b) { return a.stamp < b.stamp; }

}  // namespace

Trajectory::Trajectory(std::vector<TimedPose> poses) : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(), isEarlier);
  const auto same = [](const TimedPose& a, const TimedPose& b) { return a.stamp == b.stamp; };
  poses_.erase(poses_.begin(), std::unique(poses_.rbegin(), poses_.rend(), same).base());  // keeps the last of equals
}

std::optional<TimedPose> Trajectory::at(Stamp stamp) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), TimedPose{stamp, {}, {}}, isEarlier);
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == stamp) return *after;
  if (after == poses_.begin()) return std::nullopt;
  const TimedPose &a = *(after - 1), &b = *after;
  const double share = secondsBetween(a.stamp, stamp) / secondsBetween(a.stamp, b.stamp);
  return TimedPose{stamp, a.position + share * (b.position - a.position), a.q_local_body.slerp(share, b.q_local_body)};
}

std::optional<Gap> Trajectory::firstGap(Stamp begin, Stamp end, double longest) const {
  if (poses_.empty() || poses_.front().stamp >= end || poses_.back().stamp <= begin) return Gap{begin, end};
  if (poses_.front().stamp > begin) return Gap{begin, poses_.front().stamp};
  for (std::size_t i = 1; i < poses_.size() && poses_[i - 1].stamp < end; ++i)
    if (poses_[i].stamp > begin && secondsBetween(poses_[i - 1].stamp, poses_[i].stamp) > longest)
      return Gap{poses_[i - 1].stamp, poses_[i].stamp};
  if (poses_.back().stamp < end) return Gap{poses_.back().stamp, end};
  return std::nullopt;
}

std::vector<Stamp> pingStamps(Stamp begin, double duration, double ping_rate) {
  std::vector<Stamp> stamps(static_cast<std::size_t>(std::floor(duration * ping_rate + 1e-9)) + 1);
  for (std::size_t i = 0; i < stamps.size(); ++i)
    stamps[i] = begin + stampFromSeconds(static_cast<double>(i) / ping_rate);
  return stamps;
}

std::vector<PingPose> pingPoses(const Trajectory& trajectory, const std::vector<Stamp>& pings, double interval) {
  std::vector<PingPose> poses;
  for (const Stamp stamp : pings) {
    const auto now = trajectory.at(stamp), later = trajectory.at(stamp + stampFromSeconds(interval));
    if (!now || !later) throw std::invalid_argument("pingPoses: the trajectory does not reach over all pings");
    poses.push_back(
        {now->position, now->q_local_body.toRotationMatrix(), (later->position - now->position) / interval});
  }
  return poses;
}

}  // namespace sas_motion::imaging
