// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bare pass that reprocess is measured against: reads a bag with rosbag::View and deserialises every message; the
// same with BagReader. usage: read_bag BAG [BagReader]
#include <fmt/format.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sas_motion/MeasurementLabel.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_msgs/TFMessage.h>

#include "bag/bag_reader.hpp"

namespace {

std::size_t readByView(const std::string& path) {
  const rosbag::Bag bag(path);
  rosbag::View view(bag);
  std::size_t read = 0;
  for (const rosbag::MessageInstance& m : view)
    read += m.instantiate<nav_msgs::Odometry>() || m.instantiate<sensor_msgs::Imu>() ||
            m.instantiate<sensor_msgs::NavSatFix>() || m.instantiate<geometry_msgs::TwistWithCovarianceStamped>() ||
            m.instantiate<sas_motion::MeasurementLabel>() || m.instantiate<tf2_msgs::TFMessage>();
  return read;
}

std::size_t readByBagReader(const std::string& path) {
  sas_motion::ros_side::BagReader bag(path);
  nav_msgs::Odometry odometry;
  sensor_msgs::Imu imu;
  sensor_msgs::NavSatFix fix;
  geometry_msgs::TwistWithCovarianceStamped twist;
  sas_motion::MeasurementLabel label;
  tf2_msgs::TFMessage tf;
  std::size_t read = 0;
  while (const auto* m = bag.next())
    read += bag.get(*m, odometry) || bag.get(*m, imu) || bag.get(*m, fix) || bag.get(*m, twist) || bag.get(*m, label) ||
            bag.get(*m, tf);
  return read;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: read_bag BAG [BagReader]\n");
    return 2;
  }
  fmt::print("{} messages\n", argc == 3 ? readByBagReader(argv[1]) : readByView(argv[1]));
}
