// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/trajectory.hpp"

#include <gtest/gtest.h>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {
namespace {

TimedPose pose(double seconds, double x, double yaw_deg = 0) {
  return {stampFromSeconds(seconds),
          {x, 2 * x, 0},
          Eigen::Quaterniond(Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitZ()))};
}

double yawDeg(const Eigen::Matrix3d& C) { return std::atan2(C(1, 0), C(0, 0)) / kRadPerDeg; }

TEST(Trajectory, MovesStraightAndTurnsTheShortWayBetweenPoses) {
  const Trajectory trajectory({pose(1, 10, 170), pose(3, 20, -170)});
  const auto at = trajectory.at(stampFromSeconds(2.5));
  ASSERT_TRUE(at);
  EXPECT_TRUE(at->position.isApprox(Eigen::Vector3d(17.5, 35, 0), 1e-12));
  EXPECT_NEAR(yawDeg(at->q_local_body.toRotationMatrix()), -175, 1e-9);
}

TEST(Trajectory, SaysNothingOutsideItsPoses) {
  const Trajectory trajectory({pose(1, 10), pose(3, 20)});
  EXPECT_FALSE(trajectory.at(stampFromSeconds(1) - 1));
  EXPECT_FALSE(trajectory.at(stampFromSeconds(3) + 1));
  ASSERT_TRUE(trajectory.at(stampFromSeconds(1)));
  ASSERT_TRUE(trajectory.at(stampFromSeconds(3)));
  EXPECT_EQ(trajectory.at(stampFromSeconds(3))->position.x(), 20);
  EXPECT_FALSE(Trajectory().at(0));
}

TEST(Trajectory, TakesPosesInAnyOrderAndTheLastOfAStamp) {
  const Trajectory trajectory({pose(3, 20), pose(1, 10), pose(3, 30), pose(2, 0)});
  ASSERT_EQ(trajectory.poses().size(), 3u);
  EXPECT_EQ(trajectory.poses().front().position.x(), 10);
  EXPECT_EQ(trajectory.poses().back().position.x(), 30);
}

TEST(Trajectory, FindsTheFirstStretchWithoutPoses) {
  const Trajectory trajectory({pose(0, 0), pose(1, 0), pose(2, 0), pose(4, 0), pose(5, 0), pose(8, 0)});
  const auto gap = [&](double begin, double end, double longest) {
    return trajectory.firstGap(stampFromSeconds(begin), stampFromSeconds(end), longest);
  };
  EXPECT_FALSE(gap(0, 8, 3));
  EXPECT_FALSE(gap(0.5, 2, 1)) << "gaps outside the stretch do not count";
  EXPECT_FALSE(gap(4, 5, 1));
  ASSERT_TRUE(gap(0.5, 8, 1.5));
  EXPECT_EQ(gap(0.5, 8, 1.5)->begin, stampFromSeconds(2));
  EXPECT_EQ(gap(0.5, 8, 1.5)->end, stampFromSeconds(4));
  EXPECT_EQ(gap(2.5, 3, 1.5)->begin, stampFromSeconds(2)) << "also where the stretch lies inside the gap";
  EXPECT_EQ(gap(-1, 5, 10)->end, stampFromSeconds(0)) << "before the first pose nothing is known, however short it is";
  EXPECT_EQ(gap(5, 9, 10)->begin, stampFromSeconds(8));
  EXPECT_TRUE(gap(9, 10, 10));
  EXPECT_TRUE(Trajectory().firstGap(0, 1, 1));
}

TEST(PingPoses, HaveTheMeanVelocityWhileTheEchoComesIn) {
  // Two estimates a millisecond apart differ by a metre: no speed of a kilometre a second.
  const Trajectory trajectory({pose(0, 0, 30), pose(1, 1, 30), pose(1.001, 2, 30), pose(3, 4, 30)});
  const auto stamps = pingStamps(stampFromSeconds(0.9), 0.2, 10);
  ASSERT_EQ(stamps.size(), 3u);
  EXPECT_EQ(stamps[2], stampFromSeconds(1.1));
  const auto poses = pingPoses(trajectory, stamps, 0.5);
  for (const auto& p : poses) EXPECT_LT(p.velocity.x(), 1 + 1 / 0.5 + 0.1);
  EXPECT_NEAR(poses[0].position.x(), 0.9, 1e-9);
  EXPECT_NEAR(poses[2].velocity.x(), 2 / 1.999, 1e-9);
  EXPECT_NEAR(yawDeg(poses[1].C_local_body), 30, 1e-9);
  EXPECT_THROW(pingPoses(trajectory, stamps, 2), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging
