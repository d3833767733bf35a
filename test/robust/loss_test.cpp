// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/robust/loss.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

class EveryLoss : public ::testing::TestWithParam<std::string> {
 protected:
  Loss loss{lossFromName(GetParam())};
};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(Loss, EveryLoss, ::testing::ValuesIn(lossNames()), nameOf);

TEST_P(EveryLoss, TheDerivativeOfRhoIsResidualTimesWeight) {
  for (const double tuning : {0.5, loss.tuning(), 10.0}) {
    const Loss scaled(loss.kind(), tuning);
    for (double r = -15.03; r < 15; r += 0.1) {
      const double h = 1e-5, slope = (scaled.rho(r + h) - scaled.rho(r - h)) / (2 * h);
      ASSERT_NEAR(slope, r * scaled.weight(r), 1e-5 * (1 + std::abs(r))) << "tuning " << tuning << ", r " << r;
    }
  }
}

TEST_P(EveryLoss, ItsSlopeIsTheDerivativeOfResidualTimesWeight) {
  const double bend = loss.kind() == LossKind::Dcs ? std::sqrt(loss.tuning()) : loss.tuning();
  for (double r = -15.03; r < 15; r += 0.1) {
    const double h = 1e-6, up = r + h, down = r - h,
                 slope = (up * loss.weight(up) - down * loss.weight(down)) / (2 * h);
    if (std::abs(std::abs(r) - bend) < 2 * h) continue;
    ASSERT_NEAR(loss.slope(r), slope, 1e-6) << "r " << r;
    ASSERT_LE(loss.slope(r), 1);
  }
  EXPECT_EQ(loss.slope(0), 1);
}

TEST_P(EveryLoss, IsHalfTheSquareNearZero) {
  EXPECT_EQ(loss.rho(0), 0);
  EXPECT_EQ(loss.weight(0), 1);
  for (const double r : {1e-3, -1e-2}) {
    EXPECT_NEAR(loss.rho(r) / (r * r / 2), 1, 1e-4);
    EXPECT_NEAR(loss.weight(r), 1, 1e-3);
  }
}

TEST_P(EveryLoss, IsEvenAndItsWeightFallsFromOneToZeroOrStays) {
  double last = 1;
  for (double r = 0; r < 1000; r = 1.1 * r + 0.01) {
    EXPECT_EQ(loss.rho(r), loss.rho(-r));
    EXPECT_EQ(loss.weight(r), loss.weight(-r));
    ASSERT_LE(loss.weight(r), last);
    ASSERT_GE(loss.weight(r), 0);
    last = loss.weight(r);
  }
  if (loss.kind() == LossKind::L2)
    EXPECT_EQ(last, 1);
  else
    EXPECT_LT(last, 0.01);
}

TEST_P(EveryLoss, BecomesLeastSquaresAsItsTuningGrows) {
  const Loss wide(loss.kind(), 1e9);
  for (const double r : {0.1, 1.0, 30.0}) {
    EXPECT_NEAR(wide.rho(r) / (r * r / 2), 1, 1e-6);
    EXPECT_NEAR(wide.weight(r), 1, 1e-6);
  }
}

TEST_P(EveryLoss, RedescendingMeansThatInfluenceFades) {
  const double near = loss.weight(2), far = 1e4 * loss.weight(1e4);
  EXPECT_EQ(loss.redescending(), far < near) << far;
}

TEST_P(EveryLoss, NamesGoThereAndBack) {
  EXPECT_EQ(lossName(lossFromName(GetParam())), GetParam());
  EXPECT_EQ(loss.tuning(), Loss::defaultTuning(loss.kind()));
}

TEST_P(EveryLoss, RefusesATuningThatIsNotPositiveAndFinite) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    try {
      Loss(loss.kind(), bad);
      ADD_FAILURE() << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(GetParam()), std::string::npos) << error.what();
    }
  }
}

/// Asymptotic efficiency on Gaussian data, E[psi']^2 / E[psi^2]; E[psi'] = E[r psi] by parts. [Huber1981]
double efficiency(const Loss& loss) {
  double slope = 0, square = 0, mass = 0;
  for (double r = -12; r <= 12; r += 1e-3) {
    const double density = std::exp(-r * r / 2), psi = r * loss.weight(r);
    slope += density * r * psi;
    square += density * psi * psi;
    mass += density;
  }
  return slope / mass * slope / square;
}

TEST(Loss, CustomaryTuningsAreNinetyFivePercentEfficient) {
  EXPECT_NEAR(efficiency(Loss(LossKind::L2)), 1, 1e-6);
  for (const LossKind kind : {LossKind::Huber, LossKind::Cauchy, LossKind::Tukey, LossKind::Welsch})
    EXPECT_NEAR(efficiency(Loss(kind)), 0.95, 5e-4) << lossName(kind);
  for (const auto& name : lossNames()) EXPECT_GT(efficiency(Loss(lossFromName(name))), 0.90) << name;
}

TEST(Loss, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  try {
    lossFromName("hubert");
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const auto& name : lossNames())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("hubert"), std::string::npos);
  }
}

}  // namespace
}  // namespace sas_motion
