// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/imaging_bridge.hpp"

#include <stdexcept>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::ins {
namespace {

using imaging::TimedPose;

constexpr double kHalfStep =
    0.01;  // of the estimated velocity's difference [s]: a few readings of an IMU, and in it waves do not bend

/// Forward, port, up to starboard, forward, up.
Vector<3> navigationAxes(const Eigen::Vector3d& v) { return {-v.y(), v.x(), v.z()}; }

Eigen::Vector3d phaseCentreForward(const imaging::SonarDescription& sonar) {
  return 0.5 * (sonar.transmitter_body + sonar.receiver_array_body);
}

/// Where transmitter and receivers are by the estimated trajectory.
class EstimatedArray {
 public:
  EstimatedArray(const imaging::Trajectory& trajectory, const imaging::SonarDescription& sonar)
      : trajectory_(trajectory), sonar_(sonar) {}

  Eigen::Quaterniond attitude(Stamp stamp) const { return at(stamp).q_local_body; }
  /// Of a ping: the middle between the transmitter at transmission and the receivers when the echo is in, which a body
  /// that accelerates or turns does not pass half-way in time.
  Eigen::Vector3d phaseCentre(Stamp ping, Stamp delay) const {
    return 0.5 * (place(ping, sonar_.transmitter_body) + place(ping + 2 * delay, sonar_.receiver_array_body));
  }
  /// Of the phase centre as a place on the body [m/s].
  Eigen::Vector3d velocity(Stamp stamp) const {
    const Stamp half = stampFromSeconds(kHalfStep);
    const Eigen::Vector3d lever = phaseCentreForward(sonar_);
    return (place(stamp + half, lever) - place(stamp - half, lever)) / (2 * kHalfStep);
  }

 private:
  TimedPose at(Stamp stamp) const {
    const auto pose = trajectory_.at(stamp);
    if (!pose)
      throw std::invalid_argument(
          "dpcReading: the estimated trajectory does not reach from the first ping to the second one's echo");
    return *pose;
  }
  Eigen::Vector3d place(Stamp stamp, const Eigen::Vector3d& lever_body) const {
    const TimedPose pose = at(stamp);
    return pose.position + pose.q_local_body * lever_body;
  }

  const imaging::Trajectory& trajectory_;
  const imaging::SonarDescription& sonar_;
};

}  // namespace

TimedPose poseIn(const LocalFrame& map, Stamp stamp, const NavigationState& state) {
  static const Eigen::Quaterniond q_body_forward(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ()));
  const Geodetic place{state.latitude / kRadPerDeg, state.longitude / kRadPerDeg, state.height};
  return {stamp, map.position_enu(place), state.q_nav_body * q_body_forward};
}

Vector<3> phaseCentre(const imaging::SonarDescription& sonar) { return navigationAxes(phaseCentreForward(sonar)); }

Aiding dpcReading(const imaging::Micronavigation& found, const imaging::SonarDescription& sonar,
                  const imaging::Trajectory& estimated, Stamp first, Stamp second) {
  const EstimatedArray array(estimated, sonar);
  const Stamp delay = stampFromSeconds(found.delay), middle = first + (second - first) / 2 + delay;
  const double T = secondsBetween(first, second);
  const Eigen::Quaterniond half_way = array.attitude(first).slerp(0.5, array.attitude(second));
  const Eigen::Vector3d mean_body =
      half_way.conjugate() * (array.phaseCentre(second, delay) - array.phaseCentre(first, delay)) / T;
  const Eigen::Vector3d velocity_body = array.attitude(middle).conjugate() * array.velocity(middle);
  const Eigen::Vector3d bend_body = velocity_body - mean_body;
  Aiding reading;
  reading.stamp = middle;
  reading.sensor = Sensor::Dpc;
  reading.array.sight_body = navigationAxes(found.sight_body);
  reading.array.velocity << found.along / T + bend_body.x(), found.sight / T + bend_body.dot(found.sight_body);
  reading.array.variance = Vector<2>(found.along_sigma, found.sight_sigma).cwiseAbs2() / (T * T);
  return reading;
}

}  // namespace sas_motion::ins
