// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "sas_motion/imaging/trajectory.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {
namespace {

/// Ten poses a second: 20 s of a circle of 50 m radius, 20 s straight on, 20 s at rest.
Trajectory circleLineRest() {
  std::vector<TimedPose> poses;
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.1 * i, angle = 2 * std::min(t, 20.0) / 50, way = 2 * std::clamp(t - 20, 0.0, 20.0);
    const Eigen::Vector3d at(50 * std::sin(angle) + way * std::cos(angle),
                             50 - 50 * std::cos(angle) + way * std::sin(angle), 0);
    poses.push_back({stampFromSeconds(t), at, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))});
  }
  return Trajectory(poses);
}

TEST(StraightestWindow, IsOnTheLineAndNotAtRest) {
  const auto begin = straightestWindow(circleLineRest(), 10, 0.5);
  ASSERT_TRUE(begin);
  EXPECT_GE(*begin, stampFromSeconds(19.9));
  EXPECT_LE(*begin, stampFromSeconds(35));
}

TEST(StraightestWindow, HasNoGap) {
  auto poses = circleLineRest().poses();
  const auto inside = [](const TimedPose& pose) {
    return pose.stamp > stampFromSeconds(24.05) && pose.stamp < stampFromSeconds(35.95);
  };
  poses.erase(std::remove_if(poses.begin(), poses.end(), inside), poses.end());
  const auto begin = straightestWindow(Trajectory(poses), 3, 0.5);
  ASSERT_TRUE(begin);
  EXPECT_TRUE(*begin <= stampFromSeconds(21.0) || *begin >= stampFromSeconds(36.0)) << *begin;
  EXPECT_FALSE(straightestWindow(Trajectory(poses), 30, 0.5));
  EXPECT_FALSE(straightestWindow(Trajectory(), 1, 0.5));
}

TEST(MeanSpeed, IsPathOverTime) { EXPECT_NEAR(meanSpeed(circleLineRest()), 80.0 / 60, 1e-3); }

TEST(ApertureFrame, LooksAcrossTheHeadingFromTheBottomUnderTheMiddle) {
  // Sailing north-east with the bow set aside by 5 degrees.
  std::vector<PingPose> poses(3);
  const Eigen::Matrix3d C = Eigen::AngleAxisd(50 * kRadPerDeg, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int i = 0; i < 3; ++i) poses[i] = {{100.0 + i, 200.0 + i, -5}, C, {1, 1, 0}};
  const ApertureFrame frame = apertureFrame(poses, 12);
  EXPECT_NEAR(frame.yaw, 50 * kRadPerDeg, 1e-12);
  const PingPose middle = frame.fromMap(poses[1]), last = frame.fromMap(poses[2]);
  EXPECT_TRUE(middle.position.isApprox(Eigen::Vector3d(0, 0, 12), 1e-9));
  EXPECT_TRUE(middle.C_local_body.isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  EXPECT_NEAR(std::atan2(last.velocity.y(), last.velocity.x()), -5 * kRadPerDeg, 1e-9);
  EXPECT_NEAR(std::atan2(last.position.y(), last.position.x()), -5 * kRadPerDeg, 1e-9);
  EXPECT_THROW(apertureFrame({}, 12), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging
