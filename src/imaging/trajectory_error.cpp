// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kMostSteps = 20;
constexpr double kSettled = 1e-5;  // [m]

/// From the mean position of the pings to the target.
Eigen::Vector3d wayTo(const std::vector<PingPose>& poses, const Eigen::Vector3d& target) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& pose : poses) middle += pose.position / static_cast<double>(poses.size());
  return target - middle;
}

double trackSpeed(const std::vector<double>& times, const std::vector<PingPose>& poses) {
  return (poses.back().position - poses.front().position).head<2>().norm() / (times.back() - times.front());
}

/// First guess of the image's shift: the means move it, and a slope in the line of sight turns the track, which moves
/// the image along by slope times range over speed.
Eigen::Vector3d imageShift(const Trend& along, const Trend& line_of_sight, double speed, const Eigen::Vector3d& way) {
  const double range = way.norm(), ground = way.head<2>().norm();
  const double outwards = -line_of_sight.mean * range / ground;
  return {along.mean + line_of_sight.slope * range / speed, std::copysign(1.0, way.y()) * outwards, 0};
}

/// The place in the plane of the bottom whose estimated paths fit the target's true ones best, by Gauss-Newton.
Eigen::Vector3d bestFit(const std::vector<EchoPath>& truth, const std::vector<EchoPath>& estimate,
                        const Eigen::Vector3d& target, const Eigen::Vector3d& guess, double sound_speed) {
  Eigen::Vector3d place = guess;
  for (int i = 0; i < kMostSteps; ++i) {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (std::size_t line = 0; line < truth.size(); ++line) {
      const EchoPath& path = estimate[line];
      const Eigen::Vector2d gradient =
          ((place - path.transmitter).normalized() + (place - path.receiver).normalized()).head<2>();
      information += gradient * gradient.transpose();
      slope += gradient * (pathLength(truth[line], target, sound_speed) - pathLength(path, place, sound_speed));
    }
    const Eigen::Vector2d step = information.ldlt().solve(slope);
    if (!step.allFinite()) return guess;
    place.head<2>() += step;
    if (step.norm() < kSettled) return place;
  }
  return place.allFinite() ? place : guess;
}

/// The trend over all receivers of all pings.
Trend pathError(const std::vector<double>& times, const std::vector<EchoPath>& truth,
                const std::vector<EchoPath>& estimate, const Eigen::Vector3d& target, const Eigen::Vector3d& image,
                double sound_speed) {
  const std::size_t receivers = truth.size() / times.size();
  std::vector<double> line_times, errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    line_times.push_back(times[i / receivers]);
    errors.push_back((pathLength(estimate[i], image, sound_speed) - pathLength(truth[i], target, sound_speed)) / 2);
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
  for (std::size_t i = 0; i < values.size(); ++i)
    squares += std::pow(values[i] - trend.mean - trend.slope * (times[i] - middle), 2);
  trend.rms = std::sqrt(squares / count);
  return trend;
}

ApertureTrajectoryError apertureTrajectoryError(const SonarDescription& sonar, const std::vector<double>& times,
                                                const std::vector<PingPose>& truth,
                                                const std::vector<PingPose>& estimate, const Eigen::Vector3d& target) {
  const Eigen::Vector3d way = wayTo(truth, target);
  std::vector<double> along, slant;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d error = estimate[i].position - truth[i].position;
    along.push_back(error.x());
    slant.push_back(-error.dot(way.normalized()));
  }
  ApertureTrajectoryError result;
  result.along = fitTrend(times, along);
  result.line_of_sight = fitTrend(times, slant);
  result.image_shift = imageShift(result.along, result.line_of_sight, trackSpeed(times, truth), way);
  const auto true_paths = echoPaths(sonar, truth), paths = echoPaths(sonar, estimate);
  const Eigen::Vector3d image = bestFit(true_paths, paths, target, target + result.image_shift, sonar.sound_speed);
  result.image_shift = image - target;
  result.path = pathError(times, true_paths, paths, target, image, sonar.sound_speed);
  return result;
}

}  // namespace sas_motion::imaging
