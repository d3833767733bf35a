// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/motion_compensation.hpp"

#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/point_target.hpp"

namespace sas_motion::imaging::testing {
namespace {

const Eigen::Vector3d kNear(0, 26.5, 0), kFar(0, 32.5, 0);

PointTargetMeasures focused(const EchoLines& lines, const Eigen::Vector3d& target) {
  ChipOptions options;
  options.half_size = 50;
  return measurePointTarget(backproject(lines, gridAround(target, 130, 130, 0.008, 0.02), {}), target, options);
}

/// The lines as if navigation had seen no deviation from the straight track.
EchoLines uncorrected(const EchoLines& lines) {
  EchoLines straight = lines;
  for (auto& path : straight.paths) path.transmitter = path.receiver = {path.transmitter.x(), 0, 10};
  return straight;
}

class Compensated : public ::testing::TestWithParam<double> {};

TEST_P(Compensated, RefocusesNearAndFarAsExactBackprojectionDoes) {
  SonarDescription sonar = smallSonar();
  sonar.near_range = 24;
  sonar.far_range = 38;
  sonar.element = 0.25;  // a narrow beam: the formula holds at broadside
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(60, 0.05, GetParam())), points({kNear, kFar}));
  const EchoLines compensated = compensateMotion(lines, {{0, 0, 10}, {1, 0, 0}}, sonar.bandwidth, {});
  for (const auto& target : {kNear, kFar}) {
    const double exact = focused(lines, target).range.peak_power;
    EXPECT_NEAR(10 * std::log10(focused(compensated, target).range.peak_power / exact), 0, 0.3);
    EXPECT_LT(10 * std::log10(focused(uncorrected(lines), target).range.peak_power / exact), -2);
  }
}
INSTANTIATE_TEST_SUITE_P(PhaseOnlyAndWithShift, Compensated, ::testing::Values(0.003, 0.03));

TEST(Compensation, FollowsReceiversThatSwayWhileTheEchoIsUnderWay) {
  SonarDescription sonar = smallSonar();
  sonar.element = 0.25;
  sonar.stop_and_hop = false;
  auto poses = track(60, 0.05, 0.003);
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].velocity += Eigen::Vector3d(0, 0.3, 0.2) * std::sin(0.7 * static_cast<double>(i));
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, poses), points({kNear}));
  EchoLines stopped = lines;
  for (auto& path : stopped.paths) path.receiver_velocity.setZero();
  const auto peak = [&](const EchoLines& recorded) {
    return focused(compensateMotion(recorded, {{0, 0, 10}, {1, 0, 0}}, sonar.bandwidth, {}), kNear).range.peak_power;
  };
  const double exact = focused(lines, kNear).range.peak_power;
  EXPECT_NEAR(10 * std::log10(peak(lines) / exact), 0, 0.3);
  EXPECT_LT(10 * std::log10(peak(stopped) / exact), -3);
}

TEST(StraightTrack, IsTheLineThroughThePhaseCentres) {
  EchoLines lines;
  for (int i = 0; i < 50; ++i) {
    EchoPath path;
    path.transmitter = path.receiver = Eigen::Vector3d(5 + 0.6 * i, 2 + 0.8 * i, 10 + (i % 2 == 0 ? 0.1 : -0.1));
    path.receiver.x() += 0.2;
    lines.paths.push_back(path);
  }
  const StraightTrack track = fitTrack(lines);
  EXPECT_NEAR(track.direction.x(), 0.6, 1e-12);
  EXPECT_NEAR(track.direction.y(), 0.8, 1e-12);
  EXPECT_NEAR(track.origin.x(), 5.1 + 0.6 * 24.5, 1e-9);
  EXPECT_NEAR(track.origin.z(), 10, 1e-9);
  lines.paths.resize(1);
  EXPECT_THROW(fitTrack(lines), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging::testing
