// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ros/solution_messages.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "sas_motion/systems/ins_gps_dvl/session.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A pose turned by yaw, then pitch, then roll.
Transform pose(double x, double y, double z, double yaw = 0, double pitch = 0, double roll = 0) {
  Transform T = Transform::Identity();
  T.translation() << x, y, z;
  T.rotate(Eigen::AngleAxisd(yaw, Vector<3>::UnitZ()) * Eigen::AngleAxisd(pitch, Vector<3>::UnitY()) *
           Eigen::AngleAxisd(roll, Vector<3>::UnitX()));
  return T;
}

geometry_msgs::TwistWithCovarianceStamped twistOf(double x, double y, double z, double variance) {
  geometry_msgs::TwistWithCovarianceStamped twist;
  twist.header.stamp = ros::Time(10, 0);
  twist.twist.twist.linear.x = x;
  twist.twist.twist.linear.y = y;
  twist.twist.twist.linear.z = z;
  for (std::size_t i = 0; i < 3; ++i) twist.twist.covariance[7 * i] = variance;
  return twist;
}

ins::NavigationSolution solutionAt(double heading) {
  ins::NavigationSolution solution;
  solution.stamp = 10 * kNanosecondsPerSecond;
  solution.state.latitude = 54.35 * kRadPerDeg;
  solution.state.longitude = 10.15 * kRadPerDeg;
  solution.state.height = 3;
  solution.state.velocity_nav << 1, 2, 0.1;
  solution.state.q_nav_body = Eigen::Quaterniond(rotationOf(Attitude{0.05, -0.1, heading}));
  solution.rate_body = Vector<3>(0.01, 0.02, -0.03);
  return solution;
}

TEST(InsConversions, AnInertialUnitUpsideDownReadsTheSameAsOneUpright) {
  sensor_msgs::Imu upright;
  upright.angular_velocity.x = 0.1;
  upright.angular_velocity.y = 0.2;
  upright.angular_velocity.z = 0.3;
  upright.linear_acceleration.x = 1;
  upright.linear_acceleration.y = 2;
  upright.linear_acceleration.z = 9.8;
  upright.orientation.w = std::cos(0.4);
  upright.orientation.z = std::sin(0.4);
  sensor_msgs::Imu turned = upright;  // half a turn about forward
  turned.angular_velocity.y *= -1;
  turned.angular_velocity.z *= -1;
  turned.linear_acceleration.y *= -1;
  turned.linear_acceleration.z *= -1;
  const Eigen::Quaterniond q = Eigen::Quaterniond(std::cos(0.4), 0, 0, std::sin(0.4)) * Eigen::Quaterniond(0, 1, 0, 0);
  turned.orientation.w = q.w();
  turned.orientation.x = q.x();
  turned.orientation.y = q.y();
  turned.orientation.z = q.z();
  const ins::Settings settings;
  const auto a = readingOf(upright, pose(0, 0, 0), settings), b = readingOf(turned, pose(1, 2, 3, 0, 0, kPi), settings);
  ASSERT_TRUE(a && b && a->attitude && b->attitude);
  EXPECT_EQ(a->imu.rate_body, Vector<3>(-0.2, 0.1, 0.3));  // starboard, forward, up
  EXPECT_EQ(a->imu.force_body, Vector<3>(-2, 1, 9.8));
  EXPECT_LT((a->imu.rate_body - b->imu.rate_body).norm(), 1e-15);
  EXPECT_LT((a->imu.force_body - b->imu.force_body).norm(), 1e-14);
  EXPECT_LT(a->attitude->q_nav_body.angularDistance(b->attitude->q_nav_body), 1e-12);
  EXPECT_NEAR(attitudeOf(a->attitude->q_nav_body.toRotationMatrix()).heading, kPi / 2 - 0.8,
              1e-12);  // yaw is counter-clockwise from east
}

TEST(InsConversions, WhatAnInertialUnitDoesNotSayIsLeftOut) {
  sensor_msgs::Imu imu;
  imu.orientation.w = 1;
  const ins::Settings settings;
  EXPECT_TRUE(readingOf(imu, pose(0, 0, 0), settings)->attitude);
  EXPECT_EQ(readingOf(imu, pose(0, 0, 0), settings)->attitude->heading_sigma,
            settings.session.config.parameters.start_heading);
  EXPECT_GT(readingOf(imu, pose(0, 0, 0), settings)->attitude->tilt_sigma, 0.1 * kRadPerDeg) << "zeros: not known";
  EXPECT_GT(readingOf(imu, pose(0, 0, 0), settings)->attitude->heading_sigma, 1 * kRadPerDeg);
  imu.orientation_covariance[8] = 0.04;
  EXPECT_EQ(readingOf(imu, pose(0, 0, 0), settings)->attitude->heading_sigma, 0.2);
  imu.orientation_covariance[8] = 1e6;  // as many say that they do not know
  EXPECT_EQ(readingOf(imu, pose(0, 0, 0), settings)->attitude->heading_sigma, kPi / 2);
  imu.orientation_covariance[0] = -1;
  ASSERT_TRUE(readingOf(imu, pose(0, 0, 0), settings));  // its rates are good
  EXPECT_FALSE(readingOf(imu, pose(0, 0, 0), settings)->attitude);
  auto broken = imu;
  broken.linear_acceleration.x = kNaN;
  EXPECT_FALSE(readingOf(broken, pose(0, 0, 0), settings));
  broken = imu;
  broken.linear_acceleration_covariance[0] = -1;
  EXPECT_FALSE(readingOf(broken, pose(0, 0, 0), settings));
}

TEST(InsConversions, LeverArmsAreFromTheInertialUnitAndAxesThoseOfTheBody) {
  const ins::Settings settings;
  const InsMount mount{pose(1, 2, 3, kPi / 2), pose(0.5, 0.5, 0.5)};
  const auto reading = readingOf(twistOf(2, 0.5, 0.1, 1e-4), mount, settings);
  ASSERT_TRUE(reading);
  EXPECT_LT((*reading->lever_body - Vector<3>(-1.5, 0.5, 2.5)).norm(), 1e-15);
  EXPECT_LT((reading->velocity_body - Vector<3>(-2, -0.5, 0.1)).norm(), 1e-15);  // it looks to port
  EXPECT_LT((*reading->variance - Vector<3>::Constant(1e-4)).norm(), 1e-18);
}

TEST(InsConversions, ADvlWithoutBottomLockHasNoReading) {
  ins::Settings settings;
  const InsMount mount;
  EXPECT_FALSE(readingOf(twistOf(kNaN, 0, 0, 1e-4), mount, settings));
  EXPECT_FALSE(readingOf(twistOf(-32.768, -32.768, -32.768, 1e-4), mount, settings));
  EXPECT_FALSE(readingOf(twistOf(2, 0, 0, -1), mount, settings));
  EXPECT_FALSE(readingOf(twistOf(2, 0, 0, 1e4), mount, settings));
  const double white = settings.session.config.parameters.dvl_white.x();
  for (const double unstated : {0.0, kNaN})  // the velocity counts, and its noise is that of the settings
    EXPECT_NEAR((*readingOf(twistOf(2, 0, 0, unstated), mount, settings)->variance)(0), white * white, 1e-18);
  settings.of(ins::Sensor::Dvl).floor = 0.5;
  EXPECT_NEAR((*readingOf(twistOf(2, 0, 0, 1e-4), mount, settings)->variance)(0), 0.25, 1e-15);
  settings.of(ins::Sensor::Dvl).time_offset = -0.25;
  EXPECT_EQ(readingOf(twistOf(2, 0, 0, 1e-4), mount, settings)->stamp, 9'750'000'000);
}

TEST(InsConversions, AFixWithoutAPositionHasNoReading) {
  ins::Settings settings;
  sensor_msgs::NavSatFix fix;
  fix.latitude = 54;
  fix.longitude = 10;
  fix.altitude = 40;
  fix.position_covariance = {1, 0, 0, 0, 4, 0, 0, 0, 9};
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  EXPECT_EQ(*readingOf(fix, {}, settings)->variance, Vector<3>(1, 4, 9));
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  EXPECT_EQ(*readingOf(fix, {}, settings)->variance, Vector<3>(0.25, 0.25, 1));
  auto broken = fix;
  broken.altitude = kNaN;
  EXPECT_FALSE(readingOf(broken, {}, settings));
  broken = fix;
  broken.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_FALSE(readingOf(broken, {}, settings));
}

TEST(InsConversions, AVelocityOfGnssIsAsSureAsItsWorstAxis) {
  const ins::Settings settings;
  auto message = twistOf(1, 2, 3, 0.04);
  ASSERT_TRUE(groundVelocityOf(message, settings));
  EXPECT_EQ(groundVelocityOf(message, settings)->velocity_nav, Vector<3>(1, 2, 3));
  EXPECT_DOUBLE_EQ(groundVelocityOf(message, settings)->sigma, 0.2);
  message.twist.covariance[7] = 0.25;
  EXPECT_DOUBLE_EQ(groundVelocityOf(message, settings)->sigma, 0.5);
  for (const std::size_t axis : {0, 7, 14}) {
    auto unsaid = twistOf(1, 2, 3, 1e-6);
    unsaid.twist.covariance[axis] = kNaN;
    EXPECT_DOUBLE_EQ(groundVelocityOf(unsaid, settings)->sigma, settings.session.alignment.ground_velocity_sigma)
        << axis;
    for (const double variance : {-1.0, 1e6}) {
      unsaid.twist.covariance[axis] = variance;
      EXPECT_FALSE(groundVelocityOf(unsaid, settings)) << axis;
    }
  }
  EXPECT_FALSE(groundVelocityOf(twistOf(kNaN, 0, 0, 0.04), settings));
}

TEST(InsConversions, DepthsAreBelowTheSurface) {
  ins::Settings settings;
  settings.surface = 36;
  geometry_msgs::PoseWithCovarianceStamped depth;
  depth.pose.pose.position.z = -10;
  EXPECT_EQ(readingOf(depth, {}, settings)->fix.height, 26);
  depth.pose.pose.position.z = kNaN;
  EXPECT_FALSE(readingOf(depth, {}, settings));
}

/// What an odometry says, as numbers: position and velocity in the base; rotation apart from another, about the axes of
/// the map.
Vector<9> numbersOf(const nav_msgs::Odometry& odometry, const Eigen::Quaterniond& about) {
  const auto& p = odometry.pose.pose;
  const auto& v = odometry.twist.twist.linear;
  const Eigen::Quaterniond q(p.orientation.w, p.orientation.x, p.orientation.y, p.orientation.z);
  Vector<9> numbers;
  numbers << p.position.x, p.position.y, p.position.z, -attitudeError(q, about), v.x, v.y, v.z;
  return numbers;
}

TEST(InsConversions, CovariancesAreThoseOfPerturbedSolutions) {
  // GIVEN a solution far from the datum and a base away from the INS, WHEN each error is put in, THEN the message's
  // covariance is that of what it changes
  const LocalFrame frame({54.2, 9.9, 0});
  const MapSettings settings;
  const Vector<3> lever(0.4, -1.2, 3.5);
  ins::NavigationSolution solution = solutionAt(0.7);
  Matrix<9> root = Matrix<9>::Random();
  const Matrix<9> P = root * root.transpose();
  solution.covariance = P;
  const auto message = odometryOf(solutionOf(movedBy(solution, lever), frame), settings);
  const auto& o = message.pose.pose.orientation;
  const Eigen::Quaterniond about(o.w, o.x, o.y, o.z);
  Matrix<9> J;
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 9; ++i) {
    const auto with = [&](double error) {
      ins::NavigationSolution wrong = solution;
      Vector<9> e = Vector<9>::Zero();
      e(i) = error;
      wrong.state.velocity_nav += e.head<3>();
      displace(wrong.state, e.segment<3>(3));
      const Vector<3> phi = e.tail<3>();
      wrong.state.q_nav_body =
          Eigen::Quaterniond(Eigen::AngleAxisd(-phi.norm(), phi.stableNormalized())) * wrong.state.q_nav_body;
      return numbersOf(odometryOf(solutionOf(movedBy(wrong, lever), frame), settings), about);
    };
    J.col(i) = (with(kStep) - with(-kStep)) / (2 * kStep);
  }
  const Matrix<9> expected = J * P * J.transpose();
  const auto pose = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.pose.covariance.data());
  const auto twist = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.twist.covariance.data());
  const double scale = expected.cwiseAbs().maxCoeff();
  EXPECT_LT((expected.topLeftCorner<6, 6>() - pose).cwiseAbs().maxCoeff(), 1e-4 * scale);
  EXPECT_LT((expected.bottomRightCorner<3, 3>() - twist.topLeftCorner<3, 3>()).cwiseAbs().maxCoeff(), 1e-4 * scale);
}

TEST(InsConversions, ASolutionGoesOutInRep103AndComesBack) {
  const LocalFrame frame({54.35, 10.15, 0});
  ins::NavigationSolution solution = solutionAt(kPi / 2);  // bound east
  solution.state.q_nav_body = Eigen::Quaterniond(rotationOf(Attitude{0, 0, kPi / 2}));
  const auto odometry = odometryOf(solutionOf(solution, frame), {});
  EXPECT_NEAR(odometry.pose.pose.orientation.w, 1, 1e-12);  // x of the base is east
  EXPECT_NEAR(odometry.pose.pose.position.z, 3, 1e-9);
  EXPECT_NEAR(odometry.twist.twist.linear.x, 1, 1e-12);
  EXPECT_NEAR(odometry.twist.twist.linear.y, 2, 1e-12);  // north is to port
  EXPECT_NEAR(odometry.twist.twist.angular.x, 0.02, 1e-12);
  EXPECT_NEAR(odometry.twist.twist.angular.y, -0.01, 1e-12);
  EXPECT_EQ(odometry.pose.covariance[0], 0);  // unknown
  solution.has_attitude = solution.has_velocity = false;
  solution.rate_body.reset();
  const auto position = odometryOf(solutionOf(solution, frame), {});
  EXPECT_EQ(position.pose.covariance[35], 1e6);
  EXPECT_EQ(position.twist.covariance[0], 1e6);
  EXPECT_EQ(position.twist.covariance[35], 1e6);
}

}  // namespace
}  // namespace sas_motion::ros_side
