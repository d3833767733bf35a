// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/trajectory_error.hpp"

#include <cmath>
#include <numeric>

namespace sas_motion::imaging {
namespace {

/// From the middle of the pings to the target.
Eigen::Vector3d wayTo(const std::vector<PingPose>& poses, const Eigen::Vector3d& target) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& pose : poses) middle += pose.position / static_cast<double>(poses.size());
  return target - middle;
}

/// Over all receivers of all pings.
Trend pathError(const SonarDescription& sonar, const std::vector<double>& times, const std::vector<PingPose>& truth, const std::vector<PingPose>& estimate,
                const Eigen::Vector3d& target) {
  const auto true_paths = echoPaths(sonar, truth), paths = echoPaths(sonar, estimate);
  const std::size_t receivers = paths.size() / times.size();
  std::vector<double> line_times, errors;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    line_times.push_back(times[i / receivers]);
    errors.push_back((pathLength(paths[i], target, sonar.sound_speed) - pathLength(true_paths[i], target, sonar.sound_speed)) / 2);
  }
  return fitTrend(line_times, errors);
}

}  // namespace

Trend fitTrend(const std::vector<double>& times, const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double middle = std::accumulate(times.begin(), times.end(), 0.0) / count;
  Trend trend;
  trend.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double tt = 0, ty = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    tt += (times[i] - middle) * (times[i] - middle);
    ty += (times[i] - middle) * (values[i] - trend.mean);
  }
  trend.slope = tt > 0 ? ty / tt : 0;
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(values[i] - trend.mean - trend.slope * (times[i] - middle), 2);
  trend.rms = std::sqrt(squares / count);
  return trend;
}

ApertureTrajectoryError apertureTrajectoryError(const SonarDescription& sonar, const std::vector<double>& times, const std::vector<PingPose>& truth,
                                                const std::vector<PingPose>& estimate, const Eigen::Vector3d& target) {
  const Eigen::Vector3d line_of_sight = wayTo(truth, target).normalized();
  std::vector<double> along, slant;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d error = estimate[i].position - truth[i].position;
    along.push_back(error.x());
    slant.push_back(-error.dot(line_of_sight));
  }
  return {fitTrend(times, along), fitTrend(times, slant), pathError(sonar, times, truth, estimate, target)};
}

Eigen::Vector3d imageShift(const ApertureTrajectoryError& error, const std::vector<PingPose>& truth, double speed, const Eigen::Vector3d& target) {
  const Eigen::Vector3d way = wayTo(truth, target);
  const double range = way.norm(), ground = way.head<2>().norm();
  const double outwards = -error.line_of_sight.mean * range / ground;
  const double along = error.along.mean + error.line_of_sight.slope * range / speed;
  return {along, std::copysign(1.0, way.y()) * outwards, 0};
}

}  // namespace sas_motion::imaging
