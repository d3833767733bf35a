// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/start.hpp"

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

constexpr Stamp kBegin = 1'000 * kNanosecondsPerSecond;

Measurement reading(Sensor sensor, double seconds, const Vector<2>& value, double sigma) {
  Measurement z;
  z.stamp = kBegin + stampFromSeconds(seconds);
  z.sensor = sensor;
  z.value = value;
  z.variance.setConstant(sigma * sigma);
  return z;
}

/// Ten seconds of a vessel that leaves (100, 200) at 2 m/s heading south, a share of its readings scattered far and
/// wide.
std::vector<Measurement> window(Random& random, double outliers) {
  std::vector<Measurement> measurements;
  const auto noise = [&](double sigma, double far) {
    return random.bernoulli(outliers) ? far * random.gaussian() : sigma * random.gaussian();
  };
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    measurements.push_back(reading(Sensor::Position, t, {100 - 2 * t + noise(1, 500), 200 + noise(1, 500)}, 1));
    measurements.push_back(reading(Sensor::Heading, t, {wrapAngle(kPi + noise(0.01, 2)), 0}, 0.01));
    measurements.push_back(reading(Sensor::Speed, t, {2 + noise(0.05, 10), 0}, 0.05));
  }
  return measurements;
}

TEST(TowfishStart, FindsTheStateUnderFortyPercentOutliers) {
  Random random = testing::announced(101);
  for (int run = 0; run < 50; ++run) {
    const auto belief = startingBelief(kBegin, window(random, 0.4), StartOptions(), 0.2);
    ASSERT_TRUE(belief);
    StateVector truth;
    truth << 100, 200, 0, 0, kPi, 2;
    const StateVector error = Model::difference(belief->mean, truth);
    EXPECT_LT(error.head<2>().norm(), 4) << run;  // any one good reading is that near
    EXPECT_LT(std::abs(error(kHeading)), 0.04) << run;
    EXPECT_LT(std::abs(error(kSpeed)), 0.2) << run;
  }
}

TEST(TowfishStart, NeedsAPositionAndAHeading) {
  Random random = testing::announced(102);
  for (const Sensor missing : {Sensor::Position, Sensor::Heading}) {
    auto measurements = window(random, 0);
    measurements.erase(
        std::remove_if(measurements.begin(), measurements.end(), [&](const auto& z) { return z.sensor == missing; }),
        measurements.end());
    EXPECT_FALSE(startingBelief(kBegin, measurements, StartOptions(), 0.2)) << sensorName(missing);
  }
  EXPECT_FALSE(startingBelief(kBegin, {}, StartOptions(), 0.2));
}

TEST(TowfishStart, WithoutASpeedItSaysThatItDoesNotKnow) {
  const std::vector<Measurement> two{reading(Sensor::Position, 0, {1, 2}, 1),
                                     reading(Sensor::Heading, 0, {3, 0}, 0.01)};
  const auto belief = startingBelief(kBegin, two, StartOptions(), 0.2);
  ASSERT_TRUE(belief);
  EXPECT_EQ(belief->mean(kSpeed), 0);
  EXPECT_GT(belief->covariance(kSpeed, kSpeed), 9);
  EXPECT_EQ(belief->mean(kHeading), 3);
  EXPECT_NEAR(belief->covariance(kCurrentNorth, kCurrentNorth), 0.04, 1e-12);
}

}  // namespace
}  // namespace sas_motion::towfish
