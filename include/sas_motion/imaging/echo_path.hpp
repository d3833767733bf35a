// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// The sonar at the transmission of a ping, in any local frame with z up.
struct PingPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the body's origin [m]
  Eigen::Matrix3d C_local_body =
      Eigen::Matrix3d::Identity();  ///< body components to local ones; body x forward, y to port, z up
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< only used without stop_and_hop [m/s]
};

/// From the transmitter to the bottom and back to one receiver.
struct EchoPath {
  Eigen::Vector3d transmitter = Eigen::Vector3d::Zero();        ///< at transmission [m]
  Eigen::Vector3d receiver = Eigen::Vector3d::Zero();           ///< at transmission [m]
  Eigen::Vector3d receiver_velocity = Eigen::Vector3d::Zero();  ///< until the echo is in; zero: stop and hop [m/s]
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();           ///< axis of the elements, for their beam

  /// Transmitter and receiver in one place that stands still: one range serves both ways.
  bool monostatic() const { return transmitter == receiver && receiver_velocity.isZero(0); }
};

/// The paths of all receivers of all pings, ping by ping. Lever arms are those of the sonar.
std::vector<EchoPath> echoPaths(const SonarDescription& sonar, const std::vector<PingPose>& poses);

/// Length of the path by way of `point`, sound speed times two-way delay [m]; exact while the receiver's velocity is
/// constant.
double pathLength(const EchoPath& path, const Eigen::Vector3d& point, double sound_speed);

/// Two-way amplitude of the elements' beam towards `point` at the carrier, 1 at broadside: sinc^2(D sin(theta) /
/// lambda).
double beamAmplitude(const EchoPath& path, const Eigen::Vector3d& point, const SonarDescription& sonar);

}  // namespace sas_motion::imaging
