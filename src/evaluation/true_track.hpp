// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/estimate/solution.hpp"

namespace sas_motion {

/// Clockwise from north [rad].
double headingOf(const Eigen::Quaterniond& q_map_base);

/// The truth at a stamp.
struct TruePoint {
  Solution solution;
  double heading = 0;  ///< interpolated on its own, see headingOf() [rad]
};

/// The truth over a run, as solutions. Their covariances say what is known: kNotEstimated marks what is not.
class TrueTrack {
 public:
  TrueTrack() = default;
  /// `points` are in time order.
  explicit TrueTrack(std::vector<Solution> points) : points_(std::move(points)) {}

  const std::vector<Solution>& points() const { return points_; }
  /// Interpolated: the straight line and the shortest rotation. Nothing outside the track and in a gap of more than a
  /// few seconds.
  std::optional<TruePoint> at(Stamp stamp) const;

 private:
  std::vector<Solution> points_;
};

/// How far the heading of an estimate is off, where both are known [rad].
std::optional<double> headingError(const Solution& estimate, const TruePoint& truth);

}  // namespace sas_motion
