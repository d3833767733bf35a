// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/robust/gate.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

TEST(ChiSquaredGate, ThresholdIsTheQuantileOfTheRows) {
  const ChiSquaredGate gate(0.99);
  EXPECT_NEAR(gate.threshold(1), 6.635, 5e-4);
  EXPECT_NEAR(gate.threshold(2), 9.210, 5e-4);
  EXPECT_NEAR(gate.threshold(4), 13.277, 5e-4);
  for (int rows = 2; rows <= 6; ++rows) EXPECT_GT(gate.threshold(rows), gate.threshold(rows - 1));
  EXPECT_LT(ChiSquaredGate(0.9).threshold(1), gate.threshold(1));
}

}  // namespace
}  // namespace sas_motion
