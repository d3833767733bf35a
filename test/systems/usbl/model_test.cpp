// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/model.hpp"

#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "support.hpp"

namespace sas_motion::usbl {
namespace {

Ping somePing(Random& random) {
  Ping ping;
  ping.C_body_map = rotationOf({0.05 * random.gaussian(), 0.1 * random.gaussian(), 3 * random.gaussian()}).transpose();
  ping.transponder_map << 100 * random.gaussian(), 100 * random.gaussian(), -100 - 20 * random.uniform();
  return ping;
}

Unknowns someUnknowns(Random& random) {
  Unknowns x;
  for (int i = 0; i < kUnknowns; ++i) x(i) = random.gaussian() * (isAngle(i) ? 0.05 : i == kRangeScale ? 0.003 : 1);
  return x;
}

class EveryMode : public ::testing::TestWithParam<std::string> {
 protected:
  Model model{modeFromName(GetParam())};
};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(Usbl, EveryMode, ::testing::ValuesIn(modeNames()), nameOf);

TEST_P(EveryMode, ItsJacobianIsThatOfDifferences) {
  Random random = testing::announced(2);
  for (int run = 0; run < 50; ++run) {
    const Ping ping = somePing(random);
    const Unknowns x = someUnknowns(random);
    const auto H = model.jacobian(x, ping);
    for (int i = 0; i < kUnknowns; ++i) {
      const double h = isAngle(i) || i == kRangeScale ? 1e-6 : 1e-4;
      const Unknowns step = h * Unknowns::Unit(i);
      const Vector<3> numeric =
          model.difference(model.predict(Unknowns(x + step), ping), model.predict(Unknowns(x - step), ping)) / (2 * h);
      EXPECT_LT((H.col(i) - numeric).norm(), 1e-5 * (1 + numeric.norm()))
          << unknownNames()[static_cast<std::size_t>(i)];
    }
  }
}

TEST_P(EveryMode, ConvertsTheDirectionAnglesThatItWouldPredict) {
  Random random = testing::announced(3);
  for (int run = 0; run < 50; ++run) {
    const Ping ping = somePing(random);
    const Unknowns x = someUnknowns(random);
    Reading angles{Model().predict(x, ping), Vector<3>(0.04, 1e-5, 1e-5)};
    const Reading converted = model.convert(angles);
    for (int i = 0; i < kChannels; ++i) {
      if (converted.has(i)) {
        EXPECT_NEAR(model.difference(converted.value, model.predict(x, ping))(i), 0, 1e-7) << i;
      }
    }
    EXPECT_EQ(converted.has(2), GetParam() != "azimuth");
  }
}

TEST_P(EveryMode, StatesTheVarianceThatItsConversionGivesTheNoise) {
  Random random = testing::announced(4);
  const Ping ping = somePing(random);
  const Unknowns x = someUnknowns(random);
  const double sigma = 1e-4;
  Reading reading{Model().predict(x, ping), Vector<3>(0.04, sigma * sigma, sigma * sigma)};
  const Reading good = model.convert(reading);
  Vector<3> square = Vector<3>::Zero();
  constexpr int kRuns = 20000;
  for (int run = 0; run < kRuns; ++run) {
    Reading noisy = reading;
    for (int i = 1; i < 3; ++i) noisy.value(i) += sigma * random.gaussian();
    square += model.difference(model.convert(noisy).value, good.value).cwiseAbs2() / kRuns;
  }
  for (int i = 1; i < 3; ++i) {
    if (good.has(i)) {
      EXPECT_NEAR(square(i) / good.variance(i), 1, 0.05) << i;
    }
  }
}

TEST(Usbl, DirectionAnglesOfAnArrayMountedWithoutErrorAreThoseToItsAxes) {
  Ping ping;
  ping.transponder_map << 30, 0, -40;
  const Vector<3> z = Model().predict(State(State::Zero()), ping);
  EXPECT_NEAR(z(0), 50, 1e-12);
  EXPECT_NEAR(z(1), std::acos(0.6), 1e-12) << "to starboard, which is east";
  EXPECT_NEAR(z(2), kPi / 2, 1e-12) << "to forward, which is north";
}

TEST(Usbl, AHeadingErrorOfTheVesselIsOneOfTheMounting) {
  Random random = testing::announced(5);
  Ping ping = somePing(random), turned = ping;
  ping.C_body_map = rotationOf({0, 0, 0.7}).transpose();
  turned.C_body_map = rotationOf({0, 0, 0.8}).transpose();
  State x = State::Zero(), y = x;
  x(kMountingZ) = 0.1;
  EXPECT_LT((Model().predict(x, ping) - Model().predict(y, turned)).norm(), 1e-9);
}

TEST(Usbl, ADirectionThatCannotBeIsNoAzimuth) {
  const Reading impossible{{100, 0.5, 0.5}, {0.04, 1e-5, 1e-5}};  // cos^2 + cos^2 > 1
  const Reading converted = Model(Mode::AzimuthElevation).convert(impossible);
  EXPECT_TRUE(converted.has(0));
  EXPECT_FALSE(converted.has(1));
  EXPECT_FALSE(converted.has(2));
}

TEST(Usbl, ChannelsWithoutAVarianceAreAbsent) {
  for (const double variance : std::vector<double>{0, -1, NAN, INFINITY})
    EXPECT_FALSE((Reading{{1, 1, 1}, {variance, 1, 1}}).has(0)) << variance;
  EXPECT_FALSE((Reading{{NAN, 1, 1}, {1, 1, 1}}).has(0));
}

TEST(Usbl, AWrongModeSaysWhichThereAre) {
  try {
    modeFromName("bearing");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("azimuth_elevation"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sas_motion::usbl
