// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/sonar.hpp"
#include "support.hpp"

namespace sas_motion::imaging {
namespace {

SonarDescription read(const std::string& text) {
  SonarDescription sonar;
  readSonar(YamlSection::fromText(text, "sonar.yaml"), sonar);
  return sonar;
}

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  testing::expectRefused([&] { read(text); }, words);
}

TEST(SonarConfig, TheFileWithTheDefaultsIsTheDefaults) {
  SonarDescription sonar, defaults;
  sonar.carrier = 0;
  readSonar(YamlSection::fromFile(std::string(SAS_MOTION_SOURCE_DIR) + "/config/sonar.yaml"), sonar);
  EXPECT_EQ(sonar.carrier, defaults.carrier);
  EXPECT_EQ(sonar.receivers, defaults.receivers);
  EXPECT_EQ(sonar.far_range, defaults.far_range);
  EXPECT_NEAR(sonar.rangeResolution(), 0.019, 3e-4);
}

TEST(SonarConfig, ReadsWhatIsGiven) {
  const auto sonar = read(
      "{receivers: 4, spacing: 0.08, ping_rate: 10, speed: 1.5, stop_and_hop: true, transmitter_body: [0.5, 0, -0.1]}");
  EXPECT_EQ(sonar.receivers, 4);
  EXPECT_TRUE(sonar.stop_and_hop);
  EXPECT_EQ(sonar.transmitter_body, Eigen::Vector3d(0.5, 0, -0.1));
  EXPECT_NEAR(sonar.receiverBody(0).x(), -0.12, 1e-15);
  EXPECT_NEAR(sonar.receiverBody(3).x(), 0.12, 1e-15);
}

TEST(SonarConfig, RefusesWithKeyValueAndBound) {
  expectRefused("{carrier: 10}", {"sonar.yaml", "carrier", "10", "1000"});
  expectRefused("{carrier: 1000, bandwidth: 3000}", {"bandwidth", "3000", "2000"});
  expectRefused("{pulse_length: 1.0e-4}", {"pulse_length", "0.0001", "0.00025"});
  expectRefused("{spacing: 0.2}", {"spacing", "0.2", "element", "0.1"});
  expectRefused("{far_range: 20}", {"far_range", "20", "near_range"});
  expectRefused("{altitude: 45}", {"altitude", "45", "far_range"});
  expectRefused("{oversampling: 1}", {"oversampling", "1.4"});
  expectRefused("{transmitter_body: [1, 2]}", {"transmitter_body", "3"});
  expectRefused("{sonnar: 1}", {"sonnar", "carrier"});
}

TEST(SonarConfig, RefusesAPingRateThatUndersamplesOrOverlaps) {
  expectRefused("{speed: 6}", {"ping_rate", "8", "at least 15", "6 m/s"});  // 8 receivers bring 0.4 m of phase centres
  expectRefused("{receivers: 1, speed: 1}", {"ping_rate", "8", "at least 20"});           // half an element a ping
  expectRefused("{ping_rate: 16}", {"ping_rate", "16", "at most 15.3846", "far_range"});  // 2 x 45 m / c + 5 ms
  EXPECT_NO_THROW(read("{receivers: 1, speed: 0.4}"));
}

}  // namespace
}  // namespace sas_motion::imaging
