// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/true_track.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

constexpr double kLongestGap = 5;  // between two points that is interpolated over [s]

TruePoint between(const Solution& a, const Solution& b, Stamp stamp) {
  const double share = secondsBetween(a.stamp, stamp) / secondsBetween(a.stamp, b.stamp),
               heading = headingOf(a.q_map_base);
  TruePoint point{a, wrapAngle(heading + share * wrapAngle(headingOf(b.q_map_base) - heading))};
  Solution& solution = point.solution;
  solution.stamp = stamp;
  solution.position_map += share * (b.position_map - a.position_map);
  solution.velocity_base += share * (b.velocity_base - a.velocity_base);
  solution.q_map_base = a.q_map_base.slerp(share, b.q_map_base);
  solution.pose_covariance = a.pose_covariance.cwiseMax(b.pose_covariance);  // known where both are
  solution.twist_covariance = a.twist_covariance.cwiseMax(b.twist_covariance);
  if (!b.current) solution.current.reset();
  if (solution.current) solution.current->velocity_map += share * (b.current->velocity_map - a.current->velocity_map);
  return point;
}

}  // namespace

double headingOf(const Eigen::Quaterniond& q) {
  const double yaw = std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
  return wrapAngle(kPi / 2 - yaw);
}

std::optional<TruePoint> TrueTrack::at(Stamp stamp) const {
  const auto after = std::lower_bound(points_.begin(), points_.end(), stamp,
                                      [](const Solution& point, Stamp s) { return point.stamp < s; });
  if (after == points_.end()) return std::nullopt;
  if (after->stamp == stamp) return TruePoint{*after, headingOf(after->q_map_base)};
  if (after == points_.begin() || secondsBetween((after - 1)->stamp, after->stamp) > kLongestGap) return std::nullopt;
  return between(*(after - 1), *after, stamp);
}

std::optional<double> headingError(const Solution& estimate, const TruePoint& truth) {
  if (!estimate.has_heading() || !truth.solution.has_heading()) return std::nullopt;
  return wrapAngle(headingOf(estimate.q_map_base) - truth.heading);
}

}  // namespace sas_motion
