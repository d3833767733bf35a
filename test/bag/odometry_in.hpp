// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "ros/solution_messages.hpp"
#include "sas_motion/systems/ins_gps_dvl/session.hpp"

namespace sas_motion::ros_side {

/// The answers of an estimator in a reprocessed bag.
inline std::vector<nav_msgs::Odometry> odometryIn(const std::string& file, const std::string& topic) {
  BagReader bag(file);
  std::vector<nav_msgs::Odometry> all;
  nav_msgs::Odometry odometry;
  while (const BagMessage* message = bag.next())
    if (message->connection->topic == topic && bag.get(*message, odometry)) all.push_back(odometry);
  return all;
}

/// The largest ones between messages and solutions of the same stamps [m, m/s, -, relative].
struct Differences {
  double position = 0, velocity = 0, attitude = 0, covariance = 0;
};

inline Differences differencesBetween(const std::vector<nav_msgs::Odometry>& messages,
                                      const std::vector<ins::NavigationSolution>& solutions, const LocalFrame& frame) {
  Differences most;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto expected = odometryOf(solutionOf(solutions[i], frame), {});
    EXPECT_EQ(messages[i].header.stamp.nsec, expected.header.stamp.nsec);
    const auto &a = messages[i].pose.pose, &b = expected.pose.pose;
    const auto note = [](double& largest, double difference) {
      EXPECT_TRUE(std::isfinite(difference));
      largest = std::max(largest, std::abs(difference));
    };
    for (const double difference :
         {a.position.x - b.position.x, a.position.y - b.position.y, a.position.z - b.position.z})
      note(most.position, difference);
    for (const double difference : {a.orientation.x - b.orientation.x, a.orientation.y - b.orientation.y,
                                    a.orientation.z - b.orientation.z, a.orientation.w - b.orientation.w})
      note(most.attitude, difference);
    note(most.velocity, messages[i].twist.twist.linear.x - expected.twist.twist.linear.x);
    note(most.covariance, messages[i].pose.covariance[0] / expected.pose.covariance[0] - 1);
  }
  return most;
}

/// Says what the largest differences of an estimator are, and expects each below its bound.
inline void expectBelow(const std::string& estimator, const Differences& found, const Differences& bound) {
  std::cout << estimator << ": " << found.position << " m, " << found.velocity << " m/s, " << found.attitude
            << ", covariance " << found.covariance << "\n";
  EXPECT_LT(found.position, bound.position) << estimator;
  EXPECT_LT(found.velocity, bound.velocity) << estimator;
  EXPECT_LT(found.attitude, bound.attitude) << estimator;
  EXPECT_LT(found.covariance, bound.covariance) << estimator;
}

}  // namespace sas_motion::ros_side
