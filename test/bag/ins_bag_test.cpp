// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ins_recorder.hpp"
#include "pipeline/ins_stream.hpp"
#include "sas_motion/bag/reprocess.hpp"

namespace sas_motion::ros_side {
namespace {

/// The answers of an estimator in a reprocessed bag.
std::vector<nav_msgs::Odometry> odometryIn(const std::string& file, const std::string& topic) {
  BagReader bag(file);
  std::vector<nav_msgs::Odometry> all;
  nav_msgs::Odometry odometry;
  while (const BagMessage* message = bag.next())
    if (message->connection->topic == topic && bag.get(*message, odometry)) all.push_back(odometry);
  return all;
}

TEST(InsBag, AReprocessedBagSaysWhatTheSameReadingsSayInMemory) {
  // GIVEN a simulated run, WHEN it goes through messages, a bag, tf and reprocess, THEN only their rounding is between it and the run in memory
  const std::string folder = ::testing::TempDir() + "/ins_bag_test", file = folder + "/ins.bag", config = folder + "/a.yaml";
  std::filesystem::create_directories(folder + "/out");
  std::ofstream(config) << "{system: ins_gps_dvl, output_rate: 100, lag: 2, datum: [54.35, 10.15, 0]}";
  const ins::Scenario scenario = ins::testing::surveyOf(60);
  BagOutput bag(file);
  InsRecorder(scenario, 7, bag).record([](double) {});
  bag.commit();
  reprocess(file, folder + "/out", {"ckf27", "robust_ckf27"}, *makeReprocessSystem(config), [](double) {});

  const LocalFrame frame({54.35, 10.15, 0});
  for (const std::string name : {"ckf27", "robust_ckf27"}) {
    const auto messages = odometryIn(folder + "/out/ins.bag", name + "/odometry");
    const auto solutions = ins::testing::settled(ins::testing::streamOf(scenario, 7), ins::testing::optionsOf(scenario), name).solutions;
    ASSERT_EQ(messages.size(), solutions.size());
    ASSERT_GT(messages.size(), 5800u);
    double position = 0, velocity = 0, attitude = 0, covariance = 0;
    for (std::size_t i = 0; i < messages.size(); ++i) {
      const auto expected = odometryOf(solutions[i], frame, {});
      ASSERT_EQ(messages[i].header.stamp, expected.header.stamp);
      const auto &a = messages[i].pose.pose, &b = expected.pose.pose;
      position = std::max({position, std::abs(a.position.x - b.position.x), std::abs(a.position.y - b.position.y), std::abs(a.position.z - b.position.z)});
      attitude = std::max({attitude, std::abs(a.orientation.x - b.orientation.x), std::abs(a.orientation.y - b.orientation.y),
                           std::abs(a.orientation.z - b.orientation.z), std::abs(a.orientation.w - b.orientation.w)});
      velocity = std::max(velocity, std::abs(messages[i].twist.twist.linear.x - expected.twist.twist.linear.x));
      covariance = std::max(covariance, std::abs(messages[i].pose.covariance[0] / expected.pose.covariance[0] - 1));
    }
    std::cout << name << ": " << position << " m, " << velocity << " m/s, " << attitude << ", covariance " << covariance << "\n";
    EXPECT_LT(position, 1e-6);
    EXPECT_LT(velocity, 1e-8);
    EXPECT_LT(attitude, 1e-10);
    EXPECT_LT(covariance, 1e-8);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sas_motion::ros_side
