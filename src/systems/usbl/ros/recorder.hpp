// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "bag/bag_output.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "systems/usbl/ros/conversions.hpp"

namespace sas_motion {

/// Turns what the simulator of a USBL calibration gives into messages in a bag. GNSS and attitude have their own rates
/// and do not fall on pings.
class UsblRecorder {
 public:
  UsblRecorder(const usbl::Scenario& scenario, std::uint64_t seed, ros_side::BagOutput& bag);

  /// The whole scenario; `progress` is told of seconds as they pass.
  void record(const std::function<void(double)>& progress);

 private:
  void fixed();
  void truth(ros::Time time, const usbl::Pose& pose);
  void fix(ros::Time time, const usbl::Pose& pose);
  void attitude(ros::Time time, const usbl::Pose& pose);
  void ping(ros::Time time, double seconds, const usbl::Pose& pose);

  usbl::Scenario scenario_;
  usbl::Vessel vessel_;
  usbl::Simulator simulator_;
  ros_side::BagOutput& bag_;
  ros_side::UsblSettings settings_;
};

}  // namespace sas_motion
