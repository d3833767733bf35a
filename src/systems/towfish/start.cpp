// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/start.hpp"

#include <cmath>

namespace sas_motion::towfish {
namespace {

constexpr double kAgreement = 3;     // two readings agree when they differ by a few standard deviations
constexpr double kUnknownSpeed = 5;  // standard deviation without a speed sensor [m/s]

/// The index of the reading that the others lie nearest to, by the sum of Gaussian kernels of their squared distance in
/// sigmas.
template <class SquaredDistance>
std::size_t consensus(std::size_t count, SquaredDistance squared_distance) {
  std::size_t best = 0;
  double best_support = -1;
  for (std::size_t i = 0; i < count; ++i) {
    double support = 0;
    for (std::size_t j = 0; j < count; ++j)
      support += std::exp(-0.5 * squared_distance(i, j) / (kAgreement * kAgreement));
    if (support > best_support) {
      best_support = support;
      best = i;
    }
  }
  return best;
}

std::vector<Measurement> ofSensor(const std::vector<Measurement>& window, Sensor sensor) {
  std::vector<Measurement> chosen;
  for (const auto& z : window)
    if (z.sensor == sensor) chosen.push_back(z);
  return chosen;
}

}  // namespace

std::optional<Gaussian<kStates>> startingBelief(Stamp stamp, const std::vector<Measurement>& window,
                                                const StartOptions& options, double current_sigma) {
  const auto positions = ofSensor(window, Sensor::Position), headings = ofSensor(window, Sensor::Heading),
             speeds = ofSensor(window, Sensor::Speed);
  if (positions.empty() || headings.empty()) return std::nullopt;

  const double heading = headings[consensus(headings.size(), [&](std::size_t i, std::size_t j) {
                           return std::pow(wrapAngle(headings[i].value(0) - headings[j].value(0)), 2) /
                                  (headings[i].variance(0) + headings[j].variance(0));
                         })].value(0);
  const double speed = speeds.empty() ? 0 : speeds[consensus(speeds.size(), [&](std::size_t i, std::size_t j) {
                                              return std::pow(speeds[i].value(0) - speeds[j].value(0), 2) /
                                                     (speeds[i].variance(0) + speeds[j].variance(0));
                                            })].value(0);

  const Vector<2> velocity(speed * std::cos(heading), speed * std::sin(heading));
  std::vector<Vector<2>> moved;
  moved.reserve(positions.size());
  for (const auto& z : positions) moved.push_back(z.value - velocity * secondsBetween(stamp, z.stamp));
  const Vector<2> position = moved[consensus(moved.size(), [&](std::size_t i, std::size_t j) {
    return (moved[i] - moved[j]).squaredNorm() / (positions[i].variance.maxCoeff() + positions[j].variance.maxCoeff());
  })];

  Gaussian<kStates> belief;
  belief.mean << position, 0, 0, wrapAngle(heading), speed;
  Vector<kStates> sigma;
  sigma << options.position_sigma, options.position_sigma, current_sigma, current_sigma, options.heading_sigma,
      options.speed_sigma;
  if (speeds.empty()) sigma(kSpeed) += kUnknownSpeed;
  belief.covariance = sigma.cwiseAbs2().asDiagonal();
  return belief;
}

}  // namespace sas_motion::towfish
