// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/model.hpp"

namespace sas_motion::ins {

/// The body's attitude, with standard deviations.
struct MeasuredAttitude {
  Eigen::Quaterniond q_nav_body = Eigen::Quaterniond::Identity();
  double tilt_sigma = 0, heading_sigma = 0;  ///< [rad]
};

/// A reading of the IMU, with an attitude where it computes one.
struct InertialReading {
  ImuReading imu;
  std::optional<MeasuredAttitude> attitude;
};

/// The velocity over the ground on nav axes that a GNSS receiver measures. It starts the INS and is not fused later.
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
/// finds then, the others by sensor, and the IMU last, since it integrates up to its stamp.
inline std::tuple<Stamp, std::size_t> placeOf(const Reading& reading) {
  if (std::holds_alternative<GroundVelocity>(reading)) return {stampOf(reading), 0};
  const auto* aiding = std::get_if<Aiding>(&reading);
  return {stampOf(reading), 1 + (aiding ? static_cast<std::size_t>(aiding->sensor) : kSensors)};
}

// What the order of time needs to know beside that.
inline bool before(const Reading& a, const Reading& b) { return placeOf(a) < placeOf(b); }
/// The stamps of the IMU are the clock.
inline bool tellsTime(const Reading& reading) { return std::holds_alternative<InertialReading>(reading); }
inline bool suffices(const std::vector<Reading>&) { return true; }

}  // namespace sas_motion::ins
