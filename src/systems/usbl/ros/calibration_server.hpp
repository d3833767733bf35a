// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ros/serving.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/problem.hpp"
#include "systems/usbl/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// Limits of three standard deviations of a calibration that is good enough.
struct CalibrationTolerance {
  double angle = 0.1 * kRadPerDeg;  ///< [rad]
  double lever_arm = 0.1;           ///< [m]
};

/// A live USBL calibration from GNSS, attitude, transponder and USBL messages. After every ping it publishes
/// NAME/calibration and NAME/update for each filter NAME; /diagnostics reports observability and tolerance. ~save
/// writes the same as calibrate_usbl with the same messages; ~reset begins anew.
class CalibrationServer {
 public:
  /// Throws ConfigError or std::invalid_argument where a parameter is wrong.
  CalibrationServer(const ros::NodeHandle& node, const ros::NodeHandle& own);

 private:
  struct Lane {
    std::string name;
    usbl::Calibrator calibrator;
    ros::Publisher calibration, update;
  };

  void beginAnew();
  /// `has_frame` tells whether the messages' frame_id is a frame.
  template <class Message>
  void subscribe(const std::string& topic, void (UsblIngest::*take)(const Message&), bool has_frame = true);
  /// Runs a message's handler, at first after a wait for transforms.
  void receive(const std::string& frame, std::function<void()> handler);
  bool transformsReady();
  void process(const usbl::Ping& ping);
  void publish(Lane& lane, const usbl::Ping& ping, const usbl::Calibrator::Report& report);
  bool withinTolerance(const usbl::Calibrator& calibrator) const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  bool onSave(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  ros::NodeHandle node_;
  UsblSettings settings_;
  CalibrationTolerance tolerance_;
  std::string output_ = "calibration.yaml";
  double transform_wait_ = 2;  // [s, wall]
  int most_pings_ = 50'000;    // kept for ~save
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::unique_ptr<UsblIngest> ingest_;
  std::vector<std::string> names_;
  std::vector<Lane> lanes_;
  std::vector<usbl::Ping> pings_;
  Matrix<usbl::kUnknowns> information_;  // of all pings, each linearised at the first filter's mean
  usbl::Observability observability_;
  std::deque<std::function<void()>> waiting_;
  std::vector<std::string> frames_;  // of the waiting messages
  ros::WallTime first_message_;
  bool ready_ = false;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};

}  // namespace sas_motion::ros_side
