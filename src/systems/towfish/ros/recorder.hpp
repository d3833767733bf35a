// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bag/bag_output.hpp"
#include "ros/settings.hpp"
#include "sas_motion/systems/towfish/simulator.hpp"

namespace sas_motion {

/// Turns what the simulator of a towfish gives into messages in a bag.
class TowfishRecorder {
 public:
  TowfishRecorder(const towfish::Scenario& scenario, std::uint64_t seed, ros_side::BagOutput& bag)
      : scenario_(scenario), simulator_(scenario, seed), bag_(bag), frame_(scenario.datum) {}

  /// The whole scenario; `progress` gets seconds as they pass.
  void record(const std::function<void(double)>& progress);

 private:
  void transforms();
  void truth(const towfish::TruthSample& truth);
  void measurements(const std::vector<towfish::LabelledMeasurement>& measurements);
  std_msgs::Header header(const towfish::Measurement& z, const towfish::SimulatedSource& source) const;
  sensor_msgs::NavSatFix fix(const towfish::Measurement& z, const towfish::SimulatedSource& source);
  geometry_msgs::TwistWithCovarianceStamped twist(const towfish::Measurement& z,
                                                  const towfish::SimulatedSource& source);
  void fill(sensor_msgs::Imu& imu, const towfish::Measurement& z, const towfish::SimulatedSource& source) const;

  towfish::Scenario scenario_;
  towfish::Simulator simulator_;
  ros_side::BagOutput& bag_;
  LocalFrame frame_;
  ros_side::MapSettings settings_;
  std::map<std::string, std::uint32_t> seq_;  // by topic
};

}  // namespace sas_motion
