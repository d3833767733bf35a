// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/echo_lines.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/imaging/interpolator.hpp"

namespace sas_motion::imaging {

std::vector<EchoPath> echoPaths(const SonarDescription& sonar, const std::vector<PingPose>& poses) {
  std::vector<EchoPath> paths;
  paths.reserve(poses.size() * static_cast<std::size_t>(sonar.receivers));
  for (const auto& pose : poses)
    for (int receiver = 0; receiver < sonar.receivers; ++receiver) {
      EchoPath path;
      path.transmitter = pose.position + pose.C_local_body * sonar.transmitter_body;
      path.receiver = pose.position + pose.C_local_body * sonar.receiverBody(receiver);
      if (!sonar.stop_and_hop) path.receiver_velocity = pose.velocity;
      path.forward = pose.C_local_body.col(0);
      paths.push_back(path);
    }
  return paths;
}

double pathLength(const EchoPath& path, const Eigen::Vector3d& point, double sound_speed) {
  const double out = (point - path.transmitter).norm();
  const Eigen::Vector3d back = point - path.receiver;
  const Eigen::Vector3d mach = path.receiver_velocity / sound_speed;
  // |back - mach L| = L - out, with L the whole path: a quadratic in L
  const double a = 1 - mach.squaredNorm(), b = out - back.dot(mach), c = out * out - back.squaredNorm();
  return (b + std::sqrt(b * b - a * c)) / a;
}

bool EchoLines::finite(std::size_t first, std::size_t count) const {
  return std::all_of(line(first), line(first + count), [](const std::complex<float>& value) {
    return std::isfinite(value.real()) && std::isfinite(value.imag());
  });
}

double beamAmplitude(const EchoPath& path, const Eigen::Vector3d& point, const SonarDescription& sonar) {
  const auto element = [&](const Eigen::Vector3d& place) {
    return sinc(sonar.element / sonar.wavelength() * path.forward.dot((point - place).normalized()));
  };
  return element(path.transmitter) * element(path.receiver);
}

}  // namespace sas_motion::imaging
