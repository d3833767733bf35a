// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tuple>
#include <variant>

#include "sas_motion/models/ins_gps_dvl.hpp"

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

/// One reading of any sensor.
using Reading = std::variant<Aiding, InertialReading>;

inline Stamp stampOf(const Reading& reading) {
  const auto* aiding = std::get_if<Aiding>(&reading);
  return aiding ? aiding->stamp : std::get<InertialReading>(reading).imu.stamp;
}

/// The place of a reading among those that come in any order: by time, at one stamp by sensor, and the inertial unit last, since it integrates
/// up to its stamp.
inline std::tuple<Stamp, std::size_t> placeOf(const Reading& reading) {
  const auto* aiding = std::get_if<Aiding>(&reading);
  return {stampOf(reading), aiding ? static_cast<std::size_t>(aiding->sensor) : kSensors};
}

}  // namespace sas_motion::ins
