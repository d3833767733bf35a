// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/earth.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/Ellipsoid.hpp>
#include <GeographicLib/NormalGravity.hpp>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

const double kLatitudes[] = {-80, -54, -10, 0, 0.5, 32, 54, 60, 80};  // [deg]

TEST(Earth, RadiiAreThoseOfGeographicLib) {
  for (const double degrees : kLatitudes) {
    const auto R = earth::radii(degrees * kRadPerDeg, 0);
    EXPECT_NEAR(R.M, GeographicLib::Ellipsoid::WGS84().MeridionalCurvatureRadius(degrees), 2e-3);
    EXPECT_NEAR(R.N, GeographicLib::Ellipsoid::WGS84().TransverseCurvatureRadius(degrees), 2e-3);
    EXPECT_NEAR(earth::radii(degrees * kRadPerDeg, 250).M - R.M, 250, 1e-6);
    EXPECT_NEAR(earth::radii(degrees * kRadPerDeg, -50).N - R.N, -50, 1e-6);
  }
}

TEST(Earth, GravityIsTheNormalGravityOfGeographicLib) {
  for (const double degrees : kLatitudes) {
    EXPECT_NEAR(earth::gravity(degrees * kRadPerDeg, 0), GeographicLib::NormalGravity::WGS84().SurfaceGravity(degrees),
                2e-6)
        << degrees;
    double north = 0, up = 0;
    GeographicLib::NormalGravity::WGS84().Gravity(degrees, 100, north, up);
    EXPECT_NEAR(earth::gravity(degrees * kRadPerDeg, 100), -up, 3e-6) << degrees;
  }
}

TEST(Earth, DerivativesByLatitudeAreThoseOfTheFunctions) {
  const double d = 1e-5;
  for (const double degrees : kLatitudes) {
    const double L = degrees * kRadPerDeg;
    const auto ahead = earth::radii(L + d, 0), behind = earth::radii(L - d, 0), slope = earth::radiiByLatitude(L);
    EXPECT_NEAR(slope.M, (ahead.M - behind.M) / (2 * d), 1e-3);
    EXPECT_NEAR(slope.N, (ahead.N - behind.N) / (2 * d), 1e-3);
    EXPECT_NEAR(earth::gravityByLatitude(L), (earth::gravity(L + d, 0) - earth::gravity(L - d, 0)) / (2 * d), 1e-8);
  }
}

TEST(Earth, RatesTurnTheLevelFrameAsItMovesOverTheEarth) {
  const double L = 54 * kRadPerDeg;
  const Vector<3> rate = earth::rotationRate(L);
  EXPECT_NEAR(rate.norm(), earth::kRotationRate, 1e-18);
  EXPECT_NEAR(std::atan2(rate.z(), rate.y()), L, 1e-12) << "the axis of the Earth is at the pole's height";
  // North by M radians tips the frame by one radian about west; east turns it about the Earth's axis.
  const auto R = earth::radii(L, 0);
  EXPECT_NEAR((earth::transportRate(L, 0, {0, R.M, 0}) - Vector<3>(-1, 0, 0)).norm(), 0, 1e-12);
  const Vector<3> east = earth::transportRate(L, 0, {R.N * std::cos(L), 0, 0});
  EXPECT_NEAR((east - rate / earth::kRotationRate).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace sas_motion
