// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/calibrator.hpp"

#include "sas_motion/systems/usbl/simulator.hpp"
#include "support.hpp"

namespace sas_motion::usbl {
namespace {

Scenario scenario(double stated_factor = 1) {
  Scenario result;
  result.track.centre = result.transponder_map.head<2>();
  result.stated_factor = stated_factor;
  NoiseLaw law;
  law.kind = NoiseLaw::Kind::Contaminated;
  law.epsilon = 0.1;
  law.K = 10;
  result.noise.fill(law);
  return result;
}

State errorOf(const Calibrator& calibrator, const Scenario& scenario) {
  return calibrator.belief().mean - scenario.truth.head<kStates>();
}

/// Root mean square over seeds of the final error, each unknown over its scale of 0.01 degrees or 0.01 m.
double error(const std::string& filter, const Scenario& sea, const Config& config, int seeds = 10) {
  double sum = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    Calibrator calibrator(filter, config);
    for (const auto& labelled : simulatePings(sea, static_cast<std::uint64_t>(seed))) calibrator.process(labelled.ping);
    State scaled = errorOf(calibrator, sea) / 0.01;
    scaled.head<3>() /= kRadPerDeg;
    sum += scaled.squaredNorm() / kStates / seeds;
  }
  return std::sqrt(sum);
}

class EveryCalibrationFilter : public ::testing::TestWithParam<std::string> {};
std::string nameOf(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(Usbl, EveryCalibrationFilter, ::testing::ValuesIn(filterNames()), nameOf);

TEST_P(EveryCalibrationFilter, CalibratesInEveryMode) {
  Scenario clean = scenario();
  clean.noise.fill({});
  for (const auto& mode : modeNames()) {
    Config config;
    config.mode = modeFromName(mode);
    EXPECT_LT(error(GetParam(), clean, config, 2), 3) << mode;
  }
}

TEST_P(EveryCalibrationFilter, SurvivesReadingsThatAreNone) {
  Calibrator calibrator(GetParam(), {});
  auto pings = simulatePings(scenario(), 1);
  pings[10].ping.reading.value.setConstant(NAN);
  pings[100].ping.reading.variance.setConstant(-1);
  pings[101].ping.reading.variance(0) = NAN;
  pings[102].ping.transponder_map.setConstant(NAN);
  EXPECT_EQ(Calibrator(GetParam(), {}).process(pings[10].ping).verdict, Verdict::Invalid);
  for (const auto& labelled : pings) calibrator.process(labelled.ping);
  EXPECT_TRUE(calibrator.belief().mean.allFinite());
  EXPECT_LT(errorOf(calibrator, scenario()).norm(), 0.3);
}

TEST(Calibrator, RobustAndAdaptiveFiltersDoWhatTheyAreFor) {
  constexpr int kSeeds = 24;
  const double ckf = error("ckf", scenario(), {}, kSeeds), vbckf = error("vbckf", scenario(), {}, kSeeds),
               hckf = error("hckf", scenario(), {}, kSeeds), hvbckf = error("hvbckf", scenario(), {}, kSeeds);
  EXPECT_GT(ckf / hvbckf, 2);
  EXPECT_GT(vbckf / hvbckf, 1.2);
  EXPECT_NEAR(hckf / hvbckf, 1, 0.15) << "the stated noise is right";
  EXPECT_GT(error("hckf", scenario(25), {}, kSeeds) / error("hvbckf", scenario(25), {}, kSeeds), 1.2)
      << "the stated noise is 25 times too large";
}

TEST(Calibrator, WhatTheMessagesStateOfTheNoiseHardlyMatters) {
  const double right = error("hvbckf", scenario(), {});
  for (const double factor : {0.04, 25.0}) EXPECT_NEAR(error("hvbckf", scenario(factor), {}) / right, 1, 0.1) << factor;
}

/// The first ping's direction is 30 standard deviations off.
std::vector<LabelledPing> withBadStart(std::uint64_t seed) {
  auto pings = simulatePings(scenario(), seed);
  pings[0].ping.reading.value += Vector<3>(6, 0.105, -0.105);
  return pings;
}

TEST(Calibrator, AFirstOutlierDoesNotLockItIn) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Calibrator calibrator("hvbckf", {});
    for (const auto& labelled : withBadStart(seed)) calibrator.process(labelled.ping);
    const State sigma = calibrator.belief().covariance.diagonal().cwiseSqrt();
    EXPECT_LT(errorOf(calibrator, scenario()).cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 4.5) << seed;
  }
}

TEST(Calibrator, FindsOutThatItHasLockedIn) {
  Config config;
  config.start_window = 0;
  config.prior.sigma.head<3>().setConstant(10 * kRadPerDeg);
  config.cubature.rho = 0.99;
  config.cubature.trend = 0;
  config.check_window = 0;
  Calibrator unguarded("hvbckf", config);
  config.check_window = 300;
  Calibrator guarded("hvbckf", config);
  auto pings = simulatePings(scenario(), 2);
  pings[0].ping.reading.value += Vector<3>(30, 0.8, -0.8);
  for (const auto& labelled : pings) unguarded.process(labelled.ping), guarded.process(labelled.ping);
  const double lost = errorOf(unguarded, scenario()).head<3>().norm(),
               found = errorOf(guarded, scenario()).head<3>().norm();
  EXPECT_LT(found, 0.1 * kRadPerDeg);
  EXPECT_LE(found, lost * 1.5);
}

TEST(Calibrator, WaitsForItsStart) {
  Calibrator calibrator("hvbckf", {});
  const auto pings = simulatePings(scenario(), 3);
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(calibrator.process(pings[static_cast<std::size_t>(i)].ping).verdict, Verdict::Invalid);
  EXPECT_FALSE(calibrator.started());
  EXPECT_EQ(calibrator.belief().mean, State::Zero());
  for (int i = 50; i < 70; ++i) calibrator.process(pings[static_cast<std::size_t>(i)].ping);
  EXPECT_TRUE(calibrator.started());
}

TEST(Calibrator, AnUnknownFilterSaysWhichThereAre) { EXPECT_THROW(Calibrator("ekf", {}), std::invalid_argument); }

}  // namespace
}  // namespace sas_motion::usbl
