// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "bag/bag_output.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "systems/usbl/ros/conversions.hpp"

namespace sas_motion {

/// Writes the simulated readings of a USBL calibration to a bag; GNSS and attitude have their own rates.
class UsblRecorder {
 public:
  UsblRecorder(const usbl::Scenario& scenario, std::uint64_t seed, ros_side::BagOutput& bag);

  /// Records the whole scenario; `progress` gets the simulated seconds that have passed since its last call.
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
