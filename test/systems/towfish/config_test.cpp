// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/config.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

Config read(const std::string& text) {
  Config config;
  auto yaml = YamlSection::fromText(text, "towfish.yaml");
  readConfig(yaml, config);
  yaml.finish();
  return config;
}

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  testing::expectRefused([&] { read(text); }, words);
}

TEST(TowfishConfig, NothingGivenMeansTheDefaults) {
  const Config config = read("{}"), defaults;
  EXPECT_EQ(config.model.current_sigma, defaults.model.current_sigma);
  EXPECT_EQ(config.filters.robust_kf.loss.kind(), LossKind::Huber);
  EXPECT_EQ(config.filters.robust_kf.loss.tuning(), 1.345);
  EXPECT_NO_THROW(Model{config.model});
}

TEST(TowfishConfig, ReadsWhatIsGivenInSiAndDegrees) {
  const Config config = read(R"({model: {heading_noise_deg: 0.25, speed_noise: 0.1},
    sensors: {heading: {sigma_deg: 2, time_offset: -0.1, override_message: true}, speed: {enabled: false}},
    lag: 8, start: {window: 6}, estimators: {robust_kf: {loss: tukey, max_iterations: 20, robustify_process: true, calibrate: false},
    rts: {loss: cauchy, tuning: 3}, mckf: {bandwidth: 4}, mixture_kf: {scales: [1, 4, 9, 16]}}})");
  EXPECT_NEAR(config.model.heading_noise, 0.25 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(config.sensor(Sensor::Heading).sigma, 2 * kRadPerDeg, 1e-15);
  EXPECT_EQ(config.sensor(Sensor::Heading).time_offset, -0.1);
  EXPECT_TRUE(config.sensor(Sensor::Heading).override_message);
  EXPECT_FALSE(config.sensor(Sensor::Speed).enabled);
  EXPECT_EQ(config.filters.robust_kf.loss.kind(), LossKind::Tukey);
  EXPECT_EQ(config.filters.robust_kf.loss.tuning(), Loss::defaultTuning(LossKind::Tukey));  // not Huber's 1.345
  EXPECT_FALSE(config.filters.robust_kf.calibrate);
  EXPECT_TRUE(config.filters.student_t_kf.calibrate);
  EXPECT_EQ(config.rts.loss.tuning(), 3);
  EXPECT_NEAR(config.filters.mckf.loss.tuning(), 4 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(config.filters.mixture_kf.scales[3], 16);
}

TEST(TowfishConfig, RefusesWithFileKeyValueAndBound) {
  expectRefused("{model: {current_sigma: -0.1}}", {"towfish.yaml", "model.current_sigma", "-0.1", "above 0"});
  expectRefused("{model: {current_sigma: 0}}", {"model.current_sigma"});
  expectRefused("{lag: 5000}", {"lag", "5000", "3600"});
  expectRefused("{lag: 2}", {"start.window", "lag", "2"});
  expectRefused("{sensors: {position: {sigma_deg: 1}}}", {"sensors.position.sigma_deg", "known"});
  for (const char* key : {"sigma_deg", "floor_deg", "override_message"})  // a turn rate has no weight
    expectRefused(std::string("{sensors: {turn_rate: {") + key + ": 1}}}",
                  {std::string("sensors.turn_rate.") + key, "model.heading_noise_deg"});
  expectRefused("{sensors: {sonar: {}}}", {"sensors.sonar"});
  expectRefused("{estimators: {robust_kf: {loss: hubert}}}", {"estimators.robust_kf.loss", "hubert", "huber"});
  expectRefused("{estimators: {robust_kf: {max_iterations: 0}}}", {"estimators.robust_kf.max_iterations", "0"});
  expectRefused("{estimators: {robust_kf: {max_iterations: 2.5}}}", {"estimators.robust_kf.max_iterations"});
  expectRefused("{estimators: {gated_kf: {probability: 1.5}}}", {"estimators.gated_kf.probability", "1.5"});
  expectRefused("{estimators: {mixture_kf: {scales: [1, 2, 3]}}}", {"estimators.mixture_kf.scales", "4"});
  expectRefused("{estimators: {mixture_kf: {scales: [1, 2, 3, -4]}}}", {"estimators.mixture_kf.scales"});
  expectRefused("{estimators: {kf: {tuning: 1}}}", {"estimators.kf.tuning"});
  expectRefused("{modle: {}}", {"modle", "model"});
}

TEST(TowfishConfig, WhatIsAcceptedMakesEveryFilter) {
  for (const char* text : {"{estimators: {mixture_kf: {probabilities: [1, 0, 0, 0]}}}",
                           "{reset_after: 1, estimators: {gated_kf: {probability: 0.5}}}",
                           "{estimators: {student_t_kf: {degrees_of_freedom: 1e9, max_iterations: 1}}}"}) {
    const Config config = read(text);
    EXPECT_NO_THROW(MixtureKalmanFilter<kStates>{config.filters.mixture_kf}) << text;
    EXPECT_NO_THROW(GatedKalmanFilter<kStates>{config.filters.gated_kf}) << text;
    EXPECT_NO_THROW(StudentTKalmanFilter<kStates>{config.filters.student_t_kf}) << text;
    EXPECT_NO_THROW(RobustKalmanFilter<kStates>{config.filters.mckf}) << text;
  }
  expectRefused("{estimators: {mixture_kf: {probabilities: [0, 0, 0, 0]}}}", {"estimators.mixture_kf.probabilities"});
}

}  // namespace
}  // namespace sas_motion::towfish
