// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/mechanisation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion {
namespace {

/// Lines and turns in waves for ten minutes: largest errors of position [m] and attitude [rad].
std::pair<double, double> worstErrors(double rate, const ins::Track& track) {
  constexpr double kDuration = 600;
  const ins::Trajectory trajectory(track, kDuration);
  const NavigationState start = trajectory.at(0).state;
  Mechanisation ins(start, 0, {1 / rate, 0.1, 20, 200});
  std::pair<double, double> worst{0, 0};
  for (const auto& reading : ins::perfectImu(trajectory, rate, kDuration)) {
    EXPECT_LE(ins.step(reading).verdict, ImuVerdict::Integrated);
    const auto truth = trajectory.at(secondsBetween(0, reading.stamp)).state;
    worst.first = std::max(worst.first, displacement(truth, ins.state()).norm());
    worst.second = std::max(worst.second, attitudeError(ins.state().q_nav_body, truth.q_nav_body).norm());
  }
  return worst;
}

TEST(Mechanisation, StaysOnTheTruthForTenMinutesOfLinesTurnsAndWaves) {
  for (const double rate : {100.0, 200.0}) {
    const auto [position, attitude] = worstErrors(rate, {});
    EXPECT_LT(position, 1e-3) << rate << " Hz";
    EXPECT_LT(attitude, 1e-6) << rate << " Hz";
    std::cout << rate << " Hz: " << position << " m, " << attitude << " rad\n";
  }
}

TEST(Mechanisation, StaysOnTheTruthInAHighSea) {
  ins::Track track;
  track.pitch.amplitude = 6 * kRadPerDeg;  // (B.9)
  track.roll.amplitude = 8 * kRadPerDeg;
  track.heave.amplitude = 1;
  const auto [position, attitude] = worstErrors(200, track);
  EXPECT_LT(position, 1e-3);
  EXPECT_LT(attitude, 1e-6);
}

TEST(Mechanisation, ConingIsSeenBetweenReadings) {
  // GIVEN a cone of 0.1 rad at 2 Hz, whose mean rate about the up axis no single reading shows
  constexpr double kAngle = 0.1, kTurn = 2 * 2 * kPi, kRate = 100;
  const auto attitude = [&](double t) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(kAngle, Vector<3>(std::cos(kTurn * t), std::sin(kTurn * t), 0)));
  };
  NavigationState start;
  start.q_nav_body = attitude(0);
  Mechanisation ins(start, 0, {1 / kRate, 0.1, 20, 200});
  const auto rate = [&](double t) -> Vector<3> {  // body
    const Eigen::AngleAxisd step(attitude(t - 1e-5).conjugate() * attitude(t + 1e-5));
    return step.axis() * step.angle() / 2e-5;
  };
  for (int k = 1; k <= 1000; ++k) {
    Vector<3> mean = Vector<3>::Zero();
    for (int i = 0; i < 20; ++i) mean += rate((k - 1 + (i + 0.5) / 20) / kRate) / 20;
    const Vector<3> of_nav = earth::rotationRate(0);
    ins.step({stampFromSeconds(k / kRate), mean + ins.state().q_nav_body.conjugate() * of_nav,
              Vector<3>(0, 0, earth::gravity(0, 0))});
  }
  // THEN after 10 s the attitude is right; without the correction it would be off by 10 s * 0.5 kAngle^2 kTurn (kTurn
  // dt)^2 / 6 = 1.6e-3 rad
  EXPECT_LT(attitudeError(ins.state().q_nav_body, attitude(10)).norm(), 1e-4);
}

TEST(Mechanisation, ReportsGapsAndWrongRatesAsData) {
  Mechanisation ins({}, 0, {0.01, 0.1, 20, 200});
  const Vector<3> rate(0, 0, 0.1), force(0, 0, earth::gravity(0, 0));
  const auto step = [&](double time, const Vector<3>& w) {
    return ins.step({stampFromSeconds(time), w, force}).verdict;
  };
  EXPECT_EQ(step(0, rate), ImuVerdict::Started);
  EXPECT_EQ(step(0.01, rate), ImuVerdict::Integrated);
  EXPECT_EQ(step(0.01, rate), ImuVerdict::OutOfOrder);
  EXPECT_EQ(step(0.005, rate), ImuVerdict::OutOfOrder);
  EXPECT_EQ(step(0.013, rate), ImuVerdict::OffRate);
  EXPECT_EQ(step(0.033, rate), ImuVerdict::OffRate);
  EXPECT_EQ(step(0.04, Vector<3>(0, 0, 30)), ImuVerdict::Implausible);
  EXPECT_EQ(step(0.04, Vector<3>(0, 0, std::numeric_limits<double>::quiet_NaN())), ImuVerdict::Implausible);
  EXPECT_EQ(ins.stamp(), stampFromSeconds(0.033)) << "what is left out moves nothing";
  EXPECT_EQ(step(0.5, rate), ImuVerdict::Bridged);
  EXPECT_NEAR(attitudeOf(ins.state().q_nav_body.toRotationMatrix()).heading, -0.05, 1e-4) << "0.5 s at 0.1 rad/s";
}

TEST(Mechanisation, RefusesOptionsThatMakeNoSense) {
  EXPECT_THROW(Mechanisation({}, 0, {0, 0.1, 20, 200}), std::invalid_argument);
  EXPECT_THROW(Mechanisation({}, 0, {0.01, -1, 20, 200}), std::invalid_argument);
}

TEST(Displacement, AndItsReverseAgree) {
  NavigationState a;
  a.latitude = 0.9;
  a.longitude = kPi - 1e-6;
  NavigationState b = a;
  displace(b, {120, -80, 5});  // across the date line
  EXPECT_LT(b.longitude, 0);
  EXPECT_NEAR((displacement(a, b) - Vector<3>(120, -80, 5)).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace sas_motion
