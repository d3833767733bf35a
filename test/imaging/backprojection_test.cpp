// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/backprojection.hpp"

#include <limits>

#include "imaging/imaging_support.hpp"
#include "parallel/instruction_sets.hpp"

namespace sas_motion::imaging::testing {
namespace {

const Eigen::Vector3d kTarget(0.3, 29, 0);

EchoLines speckleLines(const SonarDescription& sonar, const std::vector<PingPose>& poses) {
  SpeckleOptions options;
  options.lower = {-2, 27, 0};
  options.upper = {2, 31, 0};
  options.density = 200;
  return compressedEchoes(sonar, echoPaths(sonar, poses), speckleScene(options, {}, 3));
}

/// Runs `test` with each set of vector instructions that this machine has.
template <class Test>
void onEveryTarget(Test&& test) {
  forEachInstructionSet([&] {
    SCOPED_TRACE(backprojectionTarget());
    test();
  });
}

TEST(Backprojection, IsWithin60DecibelsOfDoubleOnEveryTarget) {
  SonarDescription sonar = smallSonar();
  const EchoLines lines = speckleLines(sonar, track(100, 0.05, 0.05));
  const ImageGrid grid = gridAround({0, 29, 0}, 70, 100);
  const Image reference = backprojectReference(lines, grid, 2);
  onEveryTarget([&] { EXPECT_LT(relativeError(backproject(lines, grid, {}), reference), -60); });
}

TEST(Backprojection, IsWithin60DecibelsOfDoubleForAnArrayUnderWay) {
  SonarDescription sonar = smallSonar();
  sonar.receivers = 5;
  sonar.stop_and_hop = false;
  sonar.transmitter_body = {-0.4, 0, 0.1};
  const EchoLines lines = speckleLines(sonar, track(25, 0.25, 0.05));
  const ImageGrid grid = gridAround({0, 29, 0}, 70, 100);
  const Image reference = backprojectReference(lines, grid, 2);
  onEveryTarget([&] { EXPECT_LT(relativeError(backproject(lines, grid, {}), reference), -60); });
}

TEST(Backprojection, FocusesAPointWhereItIsOnASwayingTrack) {
  const SonarDescription sonar = smallSonar();
  const auto poses = track(150, 0.04, 0.1);
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, poses), points({kTarget}));
  const ImageGrid grid = gridAround(kTarget, 40, 40);
  const Image image = backproject(lines, grid, {});
  double beams = 0, largest = 0;
  for (const auto& path : lines.paths) beams += beamAmplitude(path, kTarget, sonar);
  for (const auto& pixel : image.pixels) largest = std::max(largest, static_cast<double>(std::abs(pixel)));
  EXPECT_NEAR(std::abs(image.at(20, 20)), beams, 1e-3 * beams);  // every line adds in phase
  EXPECT_EQ(std::abs(image.at(20, 20)), static_cast<float>(largest));
}

TEST(Backprojection, GivesTheSameBitsForAnyNumberOfThreads) {
  const SonarDescription sonar = smallSonar();
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(90, 0.05)), points({kTarget}));
  const ImageGrid grid = gridAround(kTarget, 100, 150);
  BackprojectionOptions three;
  three.threads = 3;
  EXPECT_EQ(backproject(lines, grid, {}).pixels, backproject(lines, grid, three).pixels);
}

TEST(Backprojection, PixelsThatNoLineHearsAreZero) {
  const SonarDescription sonar = smallSonar();
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(10, 0.05)), points({kTarget}));
  for (const double y : {5.0, 300.0}) {
    const Image image = backproject(lines, gridAround({0, y, 0}, 40, 40), {});
    for (const auto& pixel : image.pixels) ASSERT_EQ(std::abs(pixel), 0) << y;
  }
  const ImageGrid edge = gridAround({0, std::sqrt(26.0 * 26 - 100), 0}, 200, 40);  // half of it before the first sample
  EXPECT_LT(relativeError(backproject(lines, edge, {}), backprojectReference(lines, edge, 2)), -40);
}

TEST(Backprojection, LinesThatLookAwayAreLeftOut) {
  const SonarDescription sonar = smallSonar();
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(100, 0.1)), points({kTarget}));
  const ImageGrid grid = gridAround(kTarget, 20, 20);
  BackprojectionOptions narrow;
  narrow.half_angle = 2 * kRadPerDeg;
  const double whole = std::abs(backproject(lines, grid, {}).at(10, 10)),
               some = std::abs(backproject(lines, grid, narrow).at(10, 10));
  double heard = 0;
  for (const auto& path : lines.paths)
    if (std::abs((kTarget - path.transmitter).normalized().x()) < narrow.half_angle)
      heard += beamAmplitude(path, kTarget, sonar);
  EXPECT_NEAR(some, heard, 0.02 * heard);
  EXPECT_LT(some, 0.8 * whole);
}

TEST(Backprojection, WhatIsNotFiniteIsLeftOutAndCounted) {
  // GIVEN echoes of which one line has a sample that is no number, and another was heard nobody knows where
  const SonarDescription sonar = smallSonar();
  const auto poses = track(60, 0.05);
  auto raw = simulateEchoes(sonar, echoPaths(sonar, poses), points({kTarget}), {});
  raw.line(7)[100] = {std::numeric_limits<float>::quiet_NaN(), 0};
  raw.line(20)[raw.samples - 1] = {0, std::numeric_limits<float>::infinity()};
  EchoLines lines = compressRange(raw, sonar, {});
  EXPECT_EQ(lines.left_out, 2u);
  lines.paths[33].transmitter.x() = std::numeric_limits<double>::quiet_NaN();
  // THEN the image is that of the other lines
  auto others = poses;
  for (const int bad : {33, 20, 7}) others.erase(others.begin() + bad);
  const ImageGrid grid = gridAround(kTarget, 40, 40);
  const Image expected = backproject(
      compressRange(simulateEchoes(sonar, echoPaths(sonar, others), points({kTarget}), {}), sonar, {}), grid, {});
  EXPECT_LT(relativeError(backproject(lines, grid, {}), expected), -60);
}

TEST(Backprojection, RefusesWhatDoesNotFitAndSaysSo) {
  const SonarDescription sonar = smallSonar();
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(2, 0.05)), points({kTarget}));
  try {
    backproject(lines, gridAround(kTarget, 40000, 40000), {});
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    for (const char* part : {"40000 x 40000", "MB", "memory_limit"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  ImageGrid skew = gridAround(kTarget, 4, 4);
  skew.range_axis = {0.1, 1, 0};
  EXPECT_THROW(backproject(lines, skew, {}), std::invalid_argument);
  EXPECT_THROW(backproject(lines, gridAround(kTarget, 0, 4), {}), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging::testing
