// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>

#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/interpolator.hpp"

namespace sas_motion::imaging::testing {
namespace {

TEST(Interpolator, IsWithin75DecibelsOfABandLimitedLine) {
  Random random(5);
  constexpr int kSamples = 200;
  double error = 0, energy = 0;
  const Interpolator interpolator;
  for (int wave = 0; wave < 50; ++wave) {
    const double frequency =
        (random.uniform() - 0.5) / 1.5;  // cycles a sample, inside the band of a line sampled at 1.5 times it
    std::vector<std::complex<float>> line(kSamples);
    for (int i = 0; i < kSamples; ++i)
      line[static_cast<std::size_t>(i)] = std::complex<float>(std::polar(1.0, 2 * kPi * frequency * i));
    for (int i = 0; i < 50; ++i) {
      const double position = 50 + 100 * random.uniform();
      error +=
          std::norm(interpolator.at(line.data(), kSamples, position) - std::polar(1.0, 2 * kPi * frequency * position));
      energy += 1;
    }
  }
  EXPECT_LT(10 * std::log10(error / energy), -75);
}

TEST(EchoPath, OfAMovingReceiverSolvesTheTwoWayDelay) {
  EchoPath path;
  path.transmitter = {0, 0, 10};
  path.receiver = {-1, 0.2, 10};
  path.receiver_velocity = {3, -0.5, 0.2};
  const Eigen::Vector3d point(2, 40, 0);
  double delay = 0;
  for (int i = 0; i < 50; ++i)
    delay =
        ((point - path.transmitter).norm() + (point - path.receiver - delay * path.receiver_velocity).norm()) / 1500;
  EXPECT_NEAR(pathLength(path, point, 1500), 1500 * delay, 1e-9);
  EchoPath still;
  still.transmitter = still.receiver = {0, 0, 10};
  EXPECT_TRUE(still.monostatic());
  EXPECT_NEAR(pathLength(still, point, 1500), 2 * (point - still.transmitter).norm(), 1e-12);
}

TEST(EchoPath, PutsLeverArmsIntoTheLocalFrame) {
  SonarDescription sonar;
  sonar.receivers = 2;
  sonar.transmitter_body = {1, 0, -0.5};
  PingPose pose;
  pose.position = {10, 20, 30};
  pose.C_local_body = Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();  // forward is local y
  pose.velocity = {0, 2, 0};
  const auto paths = echoPaths(sonar, {pose, pose});
  ASSERT_EQ(paths.size(), 4u);
  EXPECT_TRUE(paths[0].transmitter.isApprox(Eigen::Vector3d(10, 21, 29.5)));
  EXPECT_TRUE(paths[1].receiver.isApprox(Eigen::Vector3d(10, 20.05, 30)));
  EXPECT_EQ(paths[2].receiver_velocity, pose.velocity);
  sonar.stop_and_hop = true;
  EXPECT_TRUE(echoPaths(sonar, {pose})[0].receiver_velocity.isZero(0));
}

TEST(Echoes, OfAPointAreAtItsDelayWithItsPhaseAfterCompression) {
  const SonarDescription sonar = smallSonar();
  const Eigen::Vector3d target(0.4, 28.7, 0);
  for (const auto filter : {RangeFilter::Equalized, RangeFilter::Matched}) {
    const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(3, 0.5)), points({target}), {}, filter);
    const Interpolator interpolator;
    for (std::size_t i = 0; i < lines.paths.size(); ++i) {
      const double length = pathLength(lines.paths[i], target, sonar.sound_speed);
      const auto peak = interpolator.at(lines.line(i), lines.samples, lines.position(length));
      const auto expected = std::polar(beamAmplitude(lines.paths[i], target, sonar),
                                       -2 * kPi * sonar.carrier / sonar.sound_speed * length);
      EXPECT_NEAR(std::abs(peak - expected), 0, 2e-3);
    }
  }
}

TEST(Echoes, AMatchedFilterGainsThePulsesSamples) {
  const SonarDescription sonar = smallSonar();
  EchoOptions noisy;
  noisy.noise = 1;
  noisy.seed = 4;
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(8, 0.5)), {}, noisy, RangeFilter::Matched);
  double power = 0;
  for (const auto& value : lines.data) power += std::norm(value) / static_cast<double>(lines.data.size());
  EXPECT_NEAR(power * sonar.pulse_length * sonar.sampleRate(), 1, 0.05);
}

TEST(Echoes, AreTheSameBitsForAnyNumberOfThreadsAndDifferForAnotherSeed) {
  const SonarDescription sonar = smallSonar();
  const auto paths = echoPaths(sonar, track(6, 0.1));
  EchoOptions options;
  options.noise = 0.1;
  const auto one = simulateEchoes(sonar, paths, points({{0, 29, 0}}), options);
  options.threads = 3;
  EXPECT_EQ(simulateEchoes(sonar, paths, points({{0, 29, 0}}), options).data, one.data);
  options.seed = 1;
  EXPECT_NE(simulateEchoes(sonar, paths, points({{0, 29, 0}}), options).data, one.data);
}

TEST(Echoes, SlantErrorsDelayTheLine) {
  const SonarDescription sonar = smallSonar();
  const auto paths = echoPaths(sonar, track(2, 0.1));
  const Eigen::Vector3d target(0, 29, 0);
  EchoOptions late;
  late.slant_errors = {0.003, 0};
  const auto clean = compressedEchoes(sonar, paths, points({target})),
             delayed = compressedEchoes(sonar, paths, points({target}), late);
  const Interpolator interpolator;
  const auto peak = [&](const EchoLines& lines, std::size_t i, double error) {
    return interpolator.at(lines.line(i), lines.samples,
                           lines.position(pathLength(paths[i], target, sonar.sound_speed) + 2 * error));
  };
  EXPECT_NEAR(std::arg(peak(delayed, 0, 0.003) / peak(clean, 0, 0)), wrapAngle(-4 * kPi * 0.003 / sonar.wavelength()),
              1e-3);
  EXPECT_NEAR(std::abs(peak(delayed, 1, 0) - peak(clean, 1, 0)), 0, 1e-6);
  late.slant_errors = {0.003};
  EXPECT_THROW(simulateEchoes(sonar, paths, {}, late), std::invalid_argument);
}

TEST(Block, HidesWhatIsBehindItAndNotItsOwnFace) {
  const Block block{{-1, 10, 0}, {1, 11, 2}};
  const Eigen::Vector3d sonar(0, 0, 10);
  EXPECT_TRUE(block.hides(sonar, {0, 11.5, 0}));
  EXPECT_FALSE(block.hides(sonar, {0, 14, 0}));  // beyond the shadow, which ends at 11 / (1 - 2/10) = 13.75
  EXPECT_TRUE(block.hides(sonar, {0, 13.7, 0}));
  EXPECT_FALSE(block.hides(sonar, {0, 9, 0}));
  EXPECT_FALSE(block.hides(sonar, {3, 11.5, 0}));
  EXPECT_FALSE(block.hides(sonar, {0, 10, 1}));  // its face
  EXPECT_TRUE(block.hides(sonar, {0, 11, 1}));   // its back
}

TEST(SpeckleScene, HasUnitPowerAnAreaAndAShadowWithNothingInIt) {
  SpeckleOptions options;
  options.lower = {-3, 26, 0};
  options.upper = {3, 32, 0};
  options.density = 400;
  const Scene plain = speckleScene(options, {}, 9);
  double power = 0;
  for (const auto& scatterer : plain.scatterers) power += std::norm(scatterer.amplitude) / 36;
  EXPECT_NEAR(power, 1, 0.05);
  EXPECT_EQ(speckleScene(options, {}, 9).scatterers.back().amplitude, plain.scatterers.back().amplitude);

  const Scene scene =
      speckleScene(options, {Block{{-2, 28, 0}, {2, 28.3, 0.5}}}, 9);  // its shadow reaches to 28.3 / 0.95 = 29.8 m
  const SonarDescription sonar = smallSonar();
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(60, 0.05)), scene);
  const auto meanPower = [&](double y) {
    const Image image = backproject(lines, gridAround({0, y, 0}, 50, 60), {});
    double sum = 0;
    for (const auto& pixel : image.pixels) sum += std::norm(pixel);
    return 10 * std::log10(sum);
  };
  EXPECT_LT(meanPower(29.2), meanPower(30.8) - 12);  // the side lobes of the range compression fill it a little
  EXPECT_GT(meanPower(28), meanPower(30.8) + 3);
}

}  // namespace
}  // namespace sas_motion::imaging::testing
