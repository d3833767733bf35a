// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/backprojection.hpp"

namespace sas_motion::imaging::testing {
namespace {

EchoLines speckle(const SonarDescription& sonar, const std::vector<PingPose>& poses) {
  SpeckleOptions options;
  options.lower = {-1.5, 28, 0};
  options.upper = {1.5, 30, 0};
  options.density = 200;
  return compressedEchoes(sonar, echoPaths(sonar, poses), speckleScene(options, {}, 3));
}

TEST(FactorizedBackprojection, IsWithin40DecibelsOfDirectOnASwayingTrack) {
  const EchoLines lines = speckle(smallSonar(), track(128, 0.05, 0.05));
  const ImageGrid grid = gridAround({0, 29, 0}, 120, 120);
  EXPECT_LT(relativeError(backprojectFactorized(lines, grid, 2), backproject(lines, grid, {})), -40);
}

TEST(FactorizedBackprojection, IsWithin40DecibelsOfDirectForAnArrayUnderWay) {
  SonarDescription sonar = smallSonar();
  sonar.receivers = 5;
  sonar.stop_and_hop = false;
  const EchoLines lines = speckle(sonar, track(25, 0.25, 0.02));
  const ImageGrid grid = gridAround({0, 29, 0}, 120, 120);
  EXPECT_LT(relativeError(backprojectFactorized(lines, grid, 2), backproject(lines, grid, {})), -40);
}

TEST(FactorizedBackprojection, GivesTheSameBitsForAnyNumberOfThreads) {
  const EchoLines lines = speckle(smallSonar(), track(20, 0.05));
  const ImageGrid grid = gridAround({0, 29, 0}, 30, 30);
  EXPECT_EQ(backprojectFactorized(lines, grid, 1).pixels, backprojectFactorized(lines, grid, 3).pixels);
}

TEST(FactorizedBackprojection, RefusesAGridBelowTheSonar) {
  const EchoLines lines = speckle(smallSonar(), track(2, 0.05));
  EXPECT_THROW(backprojectFactorized(lines, gridAround({0, 0, 0}, 30, 30), 1), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging::testing
