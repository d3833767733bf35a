// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/math/types.hpp"

/// Figure, rotation and normal gravity of the Earth by WGS 84. Latitudes are in radians, heights above the ellipsoid.
namespace sas_motion::earth {

constexpr double kSemiMajorAxis = 6378137;              ///< [m]
constexpr double kEccentricitySquared = 6.69437999e-3;  ///< [-]
constexpr double kRotationRate = 7.292115e-5;           ///< [rad/s]
constexpr double kGravityPerHeight = 3.086e-6;          ///< decrease of gravity [1/s^2]

/// Radii of curvature plus the height: M along the meridian, N across it [m].
struct Radii {
  double M = 0, N = 0;
};

inline Radii radiiBySine(double sine_of_latitude, double height) {
  const double w = 1 - kEccentricitySquared * sine_of_latitude * sine_of_latitude;
  return {kSemiMajorAxis * (1 - kEccentricitySquared) / (w * std::sqrt(w)) + height,
          kSemiMajorAxis / std::sqrt(w) + height};
}

inline Radii radii(double latitude, double height) { return radiiBySine(std::sin(latitude), height); }

/// Derivatives of the radii by latitude [m/rad].
inline Radii radiiByLatitude(double latitude) {
  const double s = std::sin(latitude), c = std::cos(latitude), w = 1 - kEccentricitySquared * s * s;
  const Radii R = radii(latitude, 0);
  return {3 * kEccentricitySquared * s * c / w * R.M, kEccentricitySquared * s * c / w * R.N};
}

/// Magnitude of gravity, downwards [m/s^2].
inline double gravityBySine(double sine_of_latitude, double height) {
  const double s2 = sine_of_latitude * sine_of_latitude;
  return 9.780325 * (1 + 5.2790414e-3 * s2 + 2.32718e-5 * s2 * s2) - kGravityPerHeight * height;
}

inline double gravity(double latitude, double height) { return gravityBySine(std::sin(latitude), height); }

inline double gravityByLatitude(double latitude) {
  const double s = std::sin(latitude), c = std::cos(latitude);
  return 9.780325 * 2 * s * c * (5.2790414e-3 + 2 * 2.32718e-5 * s * s);
}

/// Rotation of the Earth; east, north, up [rad/s].
inline Vector<3> rotationRate(double latitude) {
  return {0, kRotationRate * std::cos(latitude), kRotationRate * std::sin(latitude)};
}

/// Rotation of the local level frame over the Earth by a velocity east, north, up [rad/s].
inline Vector<3> transportRate(double latitude, double height, const Vector<3>& velocity_nav) {
  const Radii R = radii(latitude, height);
  return {-velocity_nav.y() / R.M, velocity_nav.x() / R.N, velocity_nav.x() * std::tan(latitude) / R.N};
}

}  // namespace sas_motion::earth
