// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tuple>
#include <variant>

#include "sas_motion/systems/ins_gps_dvl/model.hpp"

namespace sas_motion::ins {

/// How the body lies, with standard deviations.
struct MeasuredAttitude {
  Eigen::Quaterniond q_nav_body = Eigen::Quaterniond::Identity();
  double tilt_sigma = 0, heading_sigma = 0;  ///< [rad]
};

/// What an inertial unit says, with an attitude of its own where it has one.
struct InertialReading {
  ImuReading imu;
  std::optional<MeasuredAttitude> attitude;
};

/// How fast the body goes over the ground on nav axes, as a GNSS receiver says it. It starts the INS, and aids no more.
struct GroundVelocity {
  Stamp stamp = 0;
  Vector<3> velocity_nav = Vector<3>::Zero();  ///< of the antenna
  double sigma = 0;                            ///< standard deviation, of each axis [m/s]
};

/// One reading of any sensor.
using Reading = std::variant<Aiding, GroundVelocity, InertialReading>;

inline Stamp stampOf(const Reading& reading) {
  if (const auto* inertial = std::get_if<InertialReading>(&reading)) return inertial->imu.stamp;
  const auto* aiding = std::get_if<Aiding>(&reading);
  return aiding ? aiding->stamp : std::get<GroundVelocity>(reading).stamp;
}

/// The place of a reading among those that come in any order: by time; at one stamp first the velocity, which the fix
/// finds then, the others by sensor, and the inertial unit last, since it integrates up to its stamp.
inline std::tuple<Stamp, std::size_t> placeOf(const Reading& reading) {
  if (std::holds_alternative<GroundVelocity>(reading)) return {stampOf(reading), 0};
  const auto* aiding = std::get_if<Aiding>(&reading);
  return {stampOf(reading), 1 + (aiding ? static_cast<std::size_t>(aiding->sensor) : kSensors)};
}

}  // namespace sas_motion::ins
