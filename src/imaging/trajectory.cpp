// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sas_motion::imaging {
namespace {

bool isEarlier(const TimedPose& a, const TimedPose& b) { return a.stamp < b.stamp; }

struct Stretch {
  Stamp begin = 0;
  double length = 0, bend = 0;  // bend: RMS of the distance from the line, over the length
};

/// The horizontal track between two poses and its distance from the principal axis of its points.
Stretch stretchBetween(const std::vector<TimedPose>& poses, std::size_t first, std::size_t last) {
  const auto count = static_cast<double>(last - first + 1);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = first; i <= last; ++i) mean += poses[i].position.head<2>() / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = first; i <= last; ++i) {
    const Eigen::Vector2d way = poses[i].position.head<2>() - mean;
    spread += way * way.transpose() / count;
  }
  const double half_trace = spread.trace() / 2;
  const double across =
      half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - spread.determinant()));  // the lesser eigenvalue
  const double length = (poses[last].position - poses[first].position).head<2>().norm();
  return {poses[first].stamp, length, std::sqrt(std::max(0.0, across)) / length};
}

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

std::optional<Stamp> straightestWindow(const Trajectory& trajectory, double duration, double longest_gap) {
  const auto& poses = trajectory.poses();
  const Stamp span = stampFromSeconds(duration);
  std::vector<Stretch> stretches;
  std::size_t last = 0, whole_since = 0;  // whole_since: the first pose since the latest gap
  for (std::size_t first = 0; first < poses.size(); ++first) {
    while (last < poses.size() && poses[last].stamp < poses[first].stamp + span) {
      ++last;
      if (last < poses.size() && secondsBetween(poses[last - 1].stamp, poses[last].stamp) > longest_gap)
        whole_since = last;
    }
    if (last == poses.size()) break;
    if (first >= whole_since) stretches.push_back(stretchBetween(poses, first, last));
  }
  double longest = 0;
  for (const auto& stretch : stretches) longest = std::max(longest, stretch.length);
  const Stretch* best = nullptr;
  for (const auto& stretch : stretches)
    if (stretch.length > 0 && stretch.length >= longest / 2 && (!best || stretch.bend < best->bend)) best = &stretch;
  return best ? std::optional<Stamp>(best->begin) : std::nullopt;
}

double meanSpeed(const Trajectory& trajectory) {
  const auto& poses = trajectory.poses();
  if (poses.size() < 2) return 0;
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) length += (poses[i].position - poses[i - 1].position).norm();
  return length / secondsBetween(poses.front().stamp, poses.back().stamp);
}

PingPose ApertureFrame::fromMap(const PingPose& pose_map) const {
  const Eigen::Matrix3d C_track_map = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {C_track_map * (pose_map.position - origin_map), C_track_map * pose_map.C_local_body,
          C_track_map * pose_map.velocity};
}

ApertureFrame apertureFrame(const std::vector<PingPose>& poses_map, double altitude) {
  if (poses_map.empty()) throw std::invalid_argument("apertureFrame: an aperture takes at least one ping");
  ApertureFrame frame;
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  for (const auto& pose : poses_map) {
    frame.origin_map += pose.position / static_cast<double>(poses_map.size());
    forward += pose.C_local_body.col(0);
  }
  frame.origin_map.z() -= altitude;
  frame.yaw = std::atan2(forward.y(), forward.x());
  return frame;
}

std::vector<PingPose> aperturePoses(const std::vector<PingPose>& poses_map, const ApertureFrame& frame,
                                    double altitude) {
  std::vector<PingPose> poses;
  double height = 0;
  for (const auto& pose : poses_map) {
    poses.push_back(frame.fromMap(pose));
    height += poses.back().position.z() / static_cast<double>(poses_map.size());
  }
  for (auto& pose : poses) pose.position.z() += altitude - height;
  return poses;
}

}  // namespace sas_motion::imaging
