// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>

#include "bag/bag_output.hpp"
#include "ros/settings.hpp"
#include "sas_motion/systems/ins_gps_dvl/session.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "systems/ins_gps_dvl/ros/conversions.hpp"

namespace sas_motion {

/// Turns what the simulator of a system with an INS gives into messages in a bag. The attitude of the IMU is the true
/// one with the errors of the start. The DVL sits 45 degrees turned, as many do. Where there is no GPS, a fix and a
/// velocity give the body's start.
class InsRecorder {
 public:
  InsRecorder(const ins::Scenario& scenario, std::uint64_t seed, ros_side::BagOutput& bag);
  using Simulate = std::function<ins::Recording(const ins::Trajectory&)>;
  /// Of a system with the same sensors that simulates them in its own way.
  InsRecorder(const ins::Scenario& scenario, const Simulate& simulate, bool with_gps, ros_side::BagOutput& bag);

  /// The whole scenario; `progress` gets seconds as they pass.
  void record(const std::function<void(double)>& progress);

 private:
  void transforms();
  void start();
  void truth(double seconds);
  void inertial(const ImuReading& reading);
  void aiding(const ins::LabelledAiding& labelled);
  void fix(const ins::Aiding& reading, std_msgs::Header header);
  void velocity(const Vector<3>& velocity_nav, std_msgs::Header header);
  void twist(const ins::Aiding& reading, std_msgs::Header header);
  void depth(const ins::Aiding& reading, std_msgs::Header header);
  std_msgs::Header header(Stamp since_start, const char* frame, std::uint32_t& seq) const;

  ins::Scenario scenario_;
  ins::Trajectory trajectory_;
  ins::Recording recording_;
  bool with_gps_;
  ros_side::BagOutput& bag_;
  ros_side::MapSettings settings_;
  LocalFrame frame_;
  ros_side::Transform T_base_dvl_;
  Eigen::Quaterniond attitude_error_;
  std::uint32_t imu_seq_ = 0;
  std::array<std::uint32_t, ins::kSensors> seq_{};
};

}  // namespace sas_motion
