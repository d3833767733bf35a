// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/angles.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/ping_builder.hpp"
#include "support.hpp"

namespace sas_motion::usbl {
namespace {

Config read(const std::string& text) {
  Config config;
  auto yaml = YamlSection::fromText(text, "usbl.yaml");
  readConfig(yaml, config);
  yaml.finish();
  return config;
}

std::string errorOf(const std::string& text) {
  return testing::configErrorOf([&] { read(text); });
}

TEST(UsblConfig, TheFileHoldsTheDefaults) {
  auto yaml = YamlSection::fromFile(SAS_MOTION_SOURCE_DIR "/config/usbl.yaml");
  Config config;
  const Config plain;
  PingBuilderOptions options;
  readConfig(yaml, config);
  readConfig(yaml.section("pings"), options);
  for (const char* key : {"readings", "topics", "frames"}) yaml.ignore(key);
  yaml.finish();
  EXPECT_EQ(config.mode, plain.mode);
  EXPECT_TRUE(config.prior.mean.isApprox(plain.prior.mean) && config.prior.sigma.isApprox(plain.prior.sigma));
  EXPECT_EQ(config.prior.estimated, plain.prior.estimated);
  EXPECT_EQ(config.fit.loss.kind(), plain.fit.loss.kind());
  EXPECT_EQ(config.fit.loss.tuning(), plain.fit.loss.tuning());
  EXPECT_EQ(config.fit.estimate_scale, plain.fit.estimate_scale);
  EXPECT_EQ(config.fit.max_iterations, plain.fit.max_iterations);
  EXPECT_EQ(config.fit.tolerance, plain.fit.tolerance);
  EXPECT_EQ(config.start_window, plain.start_window);
  EXPECT_EQ(config.check_window, plain.check_window);
  EXPECT_EQ(config.huber.tuning(), plain.huber.tuning());
  EXPECT_EQ(config.student_t_nu, plain.student_t_nu);
  EXPECT_EQ(config.correntropy_bandwidth, plain.correntropy_bandwidth);
  EXPECT_EQ(config.cubature.reweighting, plain.cubature.reweighting);
  EXPECT_EQ(config.cubature.increment, plain.cubature.increment);
  EXPECT_EQ(config.cubature.iterations, plain.cubature.iterations);
  EXPECT_EQ(config.cubature.tolerance, plain.cubature.tolerance);
  EXPECT_EQ(config.cubature.rho, plain.cubature.rho);
  EXPECT_EQ(config.cubature.trend, plain.cubature.trend);
  EXPECT_EQ(config.cubature.clamp, plain.cubature.clamp);
  EXPECT_EQ(config.drift, plain.drift);
  const PingBuilderOptions plain_options;
  EXPECT_EQ(options.attitude_gap, plain_options.attitude_gap);
  EXPECT_EQ(options.position_gap, plain_options.position_gap);
  EXPECT_EQ(options.wait, plain_options.wait);
}

TEST(UsblConfig, TakesWhatIsGiven) {
  const Config config = read(
      "mode: azimuth\nprior: {mounting_deg: [0, 0, 180], lever_arm_sigma: [2, 3, 4]}\nestimate: {transponder: true}\n"
      "fit: {loss: tukey}\nfilters: {increment: raw, rho: 0.9, drift_deg: [0, 0, 0.1]}");
  EXPECT_EQ(config.mode, Mode::Azimuth);
  EXPECT_DOUBLE_EQ(config.prior.mean(kMountingZ), kPi);
  EXPECT_EQ(config.prior.sigma(kLeverZ), 4);
  EXPECT_TRUE(config.prior.estimated[kTransponderZ]);
  EXPECT_FALSE(config.prior.estimated[kRangeScale]);
  EXPECT_EQ(config.fit.loss.kind(), LossKind::Tukey);
  EXPECT_EQ(config.fit.loss.tuning(), Loss::defaultTuning(LossKind::Tukey));
  EXPECT_EQ(config.cubature.increment, NoiseIncrement::Raw);
  EXPECT_EQ(config.cubature.rho, 0.9);
  EXPECT_DOUBLE_EQ(config.drift(kMountingZ), 0.1 * kRadPerDeg);
}

TEST(UsblConfig, ErrorsNameTheKeyAndWhatItMustBe) {
  EXPECT_NE(errorOf("mode: bearings").find("mode is 'bearings' but must be one of direction_angles"),
            std::string::npos);
  EXPECT_NE(errorOf("prior: {sigma: 3}").find("prior.sigma is no known key"), std::string::npos);
  EXPECT_NE(errorOf("prior: {lever_arm_sigma: [1, 0, 1]}").find("prior.lever_arm_sigma must be numbers above 0"),
            std::string::npos);
  EXPECT_NE(errorOf("filters: {rho: 1.1}").find("filters.rho is 1.1"), std::string::npos);
  EXPECT_NE(errorOf("filters: {reweighting: both}").find("filters.reweighting is 'both'"), std::string::npos);
  EXPECT_NE(errorOf("fit: {loss: huge}").find("fit.loss is 'huge'"), std::string::npos);
}

}  // namespace
}  // namespace sas_motion::usbl
