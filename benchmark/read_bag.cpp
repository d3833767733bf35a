// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The bare pass that reprocess is measured against: reads a bag and deserialises every message. usage: read_bag BAG
#include <fmt/format.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sas_motion/MeasurementLabel.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <tf2_msgs/TFMessage.h>

#include "sas_motion/bag/bag_file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: read_bag BAG\n");
    return 2;
  }
  const auto bag = sas_motion::ros_side::openBag(argv[1]);
  rosbag::View view(*bag);
  std::size_t read = 0;
  for (const rosbag::MessageInstance& m : view)
    read += m.instantiate<nav_msgs::Odometry>() || m.instantiate<sensor_msgs::Imu>() || m.instantiate<sensor_msgs::NavSatFix>() ||
            m.instantiate<geometry_msgs::TwistWithCovarianceStamped>() || m.instantiate<sas_motion::MeasurementLabel>() || m.instantiate<tf2_msgs::TFMessage>();
  fmt::print("{} messages\n", read);
}
