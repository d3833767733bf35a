// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/angles.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

TEST(WrapAngle, TheIntervalIsOpenAtMinusPiAndClosedAtPi) {
  EXPECT_EQ(wrapAngle(kPi), kPi);
  EXPECT_EQ(wrapAngle(-kPi), kPi);
  EXPECT_EQ(wrapAngle(0), 0);
  const double below = std::nextafter(kPi, 0), above = std::nextafter(kPi, 4);
  EXPECT_EQ(wrapAngle(below), below);
  EXPECT_EQ(wrapAngle(-below), -below);
  EXPECT_LT(wrapAngle(above), 0);
  EXPECT_GT(wrapAngle(-above), 0);
}

TEST(WrapAngle, IsTheSameAngleAfterManyTurns) {
  Random random = testing::announced(1);
  for (int i = 0; i < 2000; ++i) {
    const double angle = 1e4 * random.gaussian(), wrapped = wrapAngle(angle);
    ASSERT_GT(wrapped, -kPi);
    ASSERT_LE(wrapped, kPi);
    ASSERT_NEAR(std::sin(wrapped), std::sin(angle), 1e-10) << angle;
    ASSERT_NEAR(std::cos(wrapped), std::cos(angle), 1e-10) << angle;
  }
  for (const double turns : {-1001.0, -3.0, -1.0, 1.0, 3.0, 1001.0})
    EXPECT_NEAR(std::abs(wrapAngle(turns * kPi)), kPi, 1e-9) << turns;
}

TEST(WrapAngle, WhatIsNoAngleStaysNone) {
  EXPECT_TRUE(std::isnan(wrapAngle(std::nan(""))));
  EXPECT_TRUE(std::isnan(wrapAngle(HUGE_VAL)));
}

}  // namespace
}  // namespace sas_motion
