// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/local_frame.hpp"

#include <cmath>

#include "sas_motion/math/angles.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

class Datum : public ::testing::TestWithParam<Geodetic> {};
INSTANTIATE_TEST_SUITE_P(LocalFrame, Datum,
                         ::testing::Values(Geodetic{54.35, 10.15, 0}, Geodetic{-17.5, 179.999, 12},
                                           Geodetic{0, -180, -30}, Geodetic{89.9, 33, 0}, Geodetic{-89.9, -120, 5},
                                           Geodetic{0, 0, 0}));

TEST_P(Datum, RoundTripsToAMillimetreOverTenKilometres) {
  Random random = testing::announced(5);
  const LocalFrame frame(GetParam());
  for (int i = 0; i < 100; ++i) {
    const Vector<3> position(7000 * random.gaussian(), 7000 * random.gaussian(), 50 * random.gaussian());
    const Geodetic point = frame.geodetic(position);
    EXPECT_LT((frame.position_enu(point) - position).norm(), 1e-3);
    EXPECT_LE(std::abs(point.latitude_deg), 90);
    EXPECT_LE(std::abs(point.longitude_deg), 180);
    Geodetic turned = point;
    turned.longitude_deg += point.longitude_deg > 0 ? -360 : 360;  // the same place
    EXPECT_LT((frame.position_enu(turned) - position).norm(), 1e-3);
  }
}

TEST_P(Datum, LiesAtTheOrigin) { EXPECT_LT(LocalFrame(GetParam()).position_enu(GetParam()).norm(), 1e-6); }

TEST_P(Datum, EastIsFirstNorthSecondUpThird) {
  const LocalFrame frame(GetParam());
  Geodetic north = GetParam(), up = GetParam();
  north.latitude_deg += GetParam().latitude_deg > 89 ? -1e-4 : 1e-4;
  up.altitude += 10;
  const Vector<3> to_north = frame.position_enu(north), to_up = frame.position_enu(up);
  EXPECT_NEAR(std::abs(to_north(1)), 11.1, 0.1);  // 1e-4 degrees of latitude
  EXPECT_NEAR(to_north(0), 0, 1e-3);
  EXPECT_LT((to_up - Vector<3>(0, 0, 10)).norm(), 1e-6);
}

TEST(LocalFrame, ADegreeOfLongitudeShrinksWithTheCosineOfLatitude) {
  const double a = 6378137, e2 = 6.69437999014e-3;  // WGS 84
  for (const double latitude : {0.0, 30.0, 60.0}) {
    const double s = std::sin(latitude * kRadPerDeg),
                 radius = a / std::sqrt(1 - e2 * s * s) * std::cos(latitude * kRadPerDeg);
    const LocalFrame frame({latitude, 20, 0});
    EXPECT_NEAR(frame.position_enu({latitude, 20.001, 0})(0), radius * 1e-3 * kRadPerDeg, 1e-5) << latitude;
  }
}

TEST(LocalFrame, RefusesADatumThatIsNoPlaceOnEarth) {
  const double nan = std::nan("");
  for (const Geodetic& bad :
       {Geodetic{91, 0, 0}, Geodetic{-90.01, 0, 0}, Geodetic{nan, 0, 0}, Geodetic{0, nan, 0}, Geodetic{0, HUGE_VAL, 0},
        Geodetic{0, 0, nan}, Geodetic{0, 3.6e9, 0}, Geodetic{0, 0, 1e300}})
    EXPECT_THROW(LocalFrame{bad}, std::invalid_argument)
        << bad.latitude_deg << " " << bad.longitude_deg << " " << bad.altitude;
}

}  // namespace
}  // namespace sas_motion
