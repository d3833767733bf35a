// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/held_input.hpp"

#include <gtest/gtest.h>

namespace sas_motion::towfish {
namespace {

TEST(HeldInput, ATurnRateIsInForceUntilTheNextOneOrItsEnd) {
  HeldInput input;
  EXPECT_EQ(input.at(stampFromSeconds(100), 1).turn_rate, 0);  // none yet
  Measurement z;
  z.sensor = Sensor::TurnRate;
  z.stamp = stampFromSeconds(100);
  z.value(0) = 0.2;
  input.take(z);
  EXPECT_EQ(input.at(z.stamp, 1).turn_rate, 0.2);
  EXPECT_EQ(input.at(stampFromSeconds(101), 1).turn_rate, 0.2);  // at the bound
  EXPECT_EQ(input.at(stampFromSeconds(101) + 1, 1).turn_rate, 0);
  z.stamp = stampFromSeconds(100.5);
  z.value(0) = -0.1;
  input.take(z);
  EXPECT_EQ(input.at(stampFromSeconds(101.25), 1).turn_rate, -0.1);
}

}  // namespace
}  // namespace sas_motion::towfish
