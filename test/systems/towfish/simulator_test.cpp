// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/simulator.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

using testing::simulate;

TEST(Simulator, TheSameSeedGivesTheSameNumbersAndAnotherDoesNot) {
  const auto scenario = testing::survey(60);
  const auto a = simulate(scenario, 1), b = simulate(scenario, 1), c = simulate(scenario, 2);
  ASSERT_EQ(a.measurements.size(), b.measurements.size());
  for (std::size_t i = 0; i < a.measurements.size(); ++i)
    ASSERT_EQ(a.measurements[i].value, b.measurements[i].value) << i;
  for (std::size_t i = 0; i < a.truth.size(); ++i) ASSERT_EQ(a.truth[i].state, b.truth[i].state) << i;
  EXPECT_NE(a.measurements[10].value, c.measurements[10].value);
}

TEST(Simulator, ASensorLessLeavesTheNoiseOfTheOthersAlone) {
  auto scenario = testing::survey(30);
  const auto all = simulate(scenario, 3);
  scenario.sensor(Sensor::Speed).rate = 0;
  const auto fewer = simulate(scenario, 3);
  std::size_t i = 0;
  for (const auto& z : all.measurements) {
    if (z.sensor == Sensor::Speed) continue;
    ASSERT_EQ(z.value, fewer.measurements[i].value) << i;
    ASSERT_EQ(z.stamp, fewer.measurements[i].stamp) << i;
    ++i;
  }
  EXPECT_EQ(i, fewer.measurements.size());
}

TEST(Simulator, SensorsKeepTheirRatesAndPhases) {
  const auto scenario = testing::survey(60);
  std::array<int, kSensors> counts{};
  for (const auto& z : simulate(scenario, 4).measurements) {
    const auto& sensor = scenario.sensor(z.sensor);
    const double beats = (secondsBetween(Simulator::kStart, z.stamp) - sensor.phase) * sensor.rate;
    ASSERT_NEAR(beats, std::round(beats), 1e-6) << sensorName(z.sensor);
    ++counts[static_cast<std::size_t>(z.sensor)];
  }
  for (int i = 0; i < kSensors; ++i)
    EXPECT_EQ(counts[static_cast<std::size_t>(i)], 60 * scenario.sources[static_cast<std::size_t>(i)].rate);
}

TEST(Simulator, MeasurementsScatterAboutTheTruthByTheirSigmaAndLabelsAreRight) {
  auto scenario = testing::survey(600);
  scenario.source(Sensor::Position).lever_arm_body << 6, -1.5;
  for (auto& sensor : scenario.sources) sensor.noise = testing::contaminated(0.2, 20);
  const auto run = simulate(scenario, 5);
  std::cout << "seed 5\n";
  std::array<std::vector<double>, kSensors> good, bad;
  for (const auto& labelled : run.labelled) {
    if (labelled.z.sensor == Sensor::TurnRate) continue;
    const auto sensor = static_cast<std::size_t>(labelled.z.sensor);
    for (int row = 0; row < rowsOf(labelled.z.sensor); ++row) {
      double off = (labelled.z.value - Model::expected(labelled.z, run.truthAt(labelled.z.stamp)))(row);
      if (labelled.z.sensor == Sensor::Heading) off = wrapAngle(off);
      (labelled.outlier[static_cast<std::size_t>(row)] ? bad : good)[sensor].push_back(
          off / std::sqrt(labelled.z.variance(row)));
    }
  }
  for (const Sensor sensor : {Sensor::Position, Sensor::Heading, Sensor::Speed}) {
    const auto i = static_cast<std::size_t>(sensor);
    const double n = static_cast<double>(good[i].size()), m = static_cast<double>(bad[i].size());
    EXPECT_NEAR(rootMeanSquare(good[i]), 1, 5 / std::sqrt(2 * n)) << sensorName(sensor);
    EXPECT_NEAR(rootMeanSquare(bad[i]), 20, 20 * 5 / std::sqrt(2 * m)) << sensorName(sensor);
    EXPECT_NEAR(m / (n + m), 0.2, 5 * std::sqrt(0.16 / (n + m))) << sensorName(sensor);
  }
}

NoiseMix lawFrom(const std::string& text) {
  auto yaml = YamlSection::fromText("{noise: " + text + "}", "inline");
  return NoiseMix::read(yaml, "noise");
}

TEST(Simulator, DropoutsTakeWholeMeasurementsAndLeaveTheOthersAlone) {
  auto scenario = testing::survey(600);
  const auto all = simulate(scenario, 8);
  scenario.sensor(Sensor::Position).noise = lawFrom("{law: dropout, probability: 0.25}");
  const auto fewer = simulate(scenario, 8);
  const double lost = static_cast<double>(all.measurements.size() - fewer.measurements.size());
  EXPECT_NEAR(lost / 600, 0.25, 5 * std::sqrt(0.1875 / 600));
  std::size_t i = 0;
  for (const auto& z : fewer.measurements) {
    while (i < all.measurements.size() &&
           (all.measurements[i].stamp != z.stamp || all.measurements[i].sensor != z.sensor)) {
      ASSERT_EQ(all.measurements[i].sensor, Sensor::Position);
      ++i;
    }
    ASSERT_EQ(all.measurements[i++].value, z.value);
  }
}

TEST(Simulator, AFrozenRowRepeatsItsLastReading) {
  auto scenario = testing::survey(600);
  scenario.sensor(Sensor::Position).noise = lawFrom("{law: frozen, rate: 0.05, length: 10}");
  Vector<2> last = Vector<2>::Zero();
  int frozen = 0;
  for (const auto& labelled : simulate(scenario, 9).labelled) {
    if (labelled.z.sensor != Sensor::Position) continue;
    for (int row = 0; row < 2; ++row) {
      const bool bad = labelled.outlier[static_cast<std::size_t>(row)];
      ASSERT_EQ(labelled.z.value(row) == last(row), bad);
      ASSERT_EQ(labelled.variance[static_cast<std::size_t>(row)], bad ? kNoInformation : 1);
      frozen += bad;
    }
    last = labelled.z.value;
  }
  EXPECT_GT(frozen, 100);
}

TEST(Simulator, QuantisedReadingsAreMultiplesOfTheQuantum) {
  auto scenario = testing::survey(60);
  scenario.sensor(Sensor::Speed).noise = lawFrom("[{law: gaussian}, {law: quantised, quantum: 2}]");
  for (const auto& labelled : simulate(scenario, 10).labelled) {
    if (labelled.z.sensor != Sensor::Speed) continue;
    EXPECT_NEAR(labelled.z.value(0) / 0.1, std::round(labelled.z.value(0) / 0.1), 1e-9);  // sigma is 0.05 m/s
    EXPECT_DOUBLE_EQ(labelled.variance[0], 1 + 4.0 / 12);
  }
}

TEST(Simulator, TruthTellsTheProcessNoiseThatItWasDrawnWith) {
  auto scenario = testing::zhu2007(60);
  scenario.process = testing::contaminated(0.2, 10);
  scenario.process.laws[0].epoch = 1;
  const auto run = simulate(scenario, 11);
  int large = 0;
  for (const auto& sample : run.truth) large += sample.process_variance(0) == 100;
  EXPECT_EQ(large % 10, 0);  // whole epochs of ten steps
  EXPECT_GT(large, 0);
}

TEST(Simulator, ASurveyTurnsAndSailsBack) {
  auto scenario = testing::survey(600);
  scenario.heading = 0.5;
  scenario.yaw_sigma = 0;
  const auto run = simulate(scenario, 6);
  std::size_t there = 0, back = 0;
  for (const auto& sample : run.truth) {
    there += std::abs(wrapAngle(sample.state(kHeading) - 0.5)) < 0.05;
    back += std::abs(wrapAngle(sample.state(kHeading) - 0.5 - kPi)) < 0.05;
  }
  const double total = static_cast<double>(run.truth.size());
  EXPECT_GT(static_cast<double>(there), 0.3 * total);
  EXPECT_GT(static_cast<double>(back), 0.2 * total);
  EXPECT_GT(static_cast<double>(there + back), 0.6 * total);  // the rest is turns of 60 s each
}

TEST(Simulator, TruthIsConsistentWithItself) {
  const auto run = simulate(testing::survey(300), 7);
  for (std::size_t i = 1; i < run.truth.size(); ++i) {
    const StateVector &a = run.truth[i - 1].state, &b = run.truth[i].state;
    const double dt = secondsBetween(run.truth[i - 1].stamp, run.truth[i].stamp);
    const Vector<2> velocity(b(kCurrentNorth) + b(kSpeed) * std::cos(b(kHeading)),
                             b(kCurrentEast) + b(kSpeed) * std::sin(b(kHeading)));
    ASSERT_LT(((b - a).head<2>() / dt - velocity).norm(), 0.02) << i;
    ASSERT_NEAR(wrapAngle(b(kHeading) - a(kHeading)) / dt, 0.5 * (run.truth[i - 1].turn_rate + run.truth[i].turn_rate),
                0.03)
        << i;
  }
}

TEST(Scenario, RefusesRatesThatMissItsSteps) {
  const auto read = [](const std::string& text) { return Scenario::read(YamlSection::fromText(text, "inline")); };
  EXPECT_NO_THROW(read("{step: 0.1, sensors: {position: {rate: 5}}}"));
  EXPECT_THROW(read("{step: 0.1, sensors: {position: {rate: 3}}}"), ConfigError);
  EXPECT_THROW(read("{step: 0.1, sensors: {position: {rate: 5, phase: 0.05}}}"), ConfigError);
  EXPECT_THROW(read("{datum: [91, 0, 0]}"), ConfigError);
  EXPECT_THROW(read("{truth: {kind: circus}}"), ConfigError);
}

}  // namespace
}  // namespace sas_motion::towfish
