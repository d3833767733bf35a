// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sas_motion/EnableSensor.h>
#include <sas_motion/GetStateAt.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "ros/serving.hpp"
#include "sas_motion/session/output_rate.hpp"
#include "sas_motion/systems/ins_gps_dvl/head.hpp"
#include "systems/ins_gps_dvl/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// The estimators of a system with an INS behind ROS topics. Fed with sensor messages it publishes, for each estimator
/// NAME,
///   NAME/odometry, NAME/fix     the best answer now, at the output rate
///   NAME/settled, NAME/update   the final answers and the audit, once no late data can change them
/// and /diagnostics, the datum, and tf of the first estimator. All callbacks run on one queue, and none of them sleeps.
class InsServer {
 public:
  /// Throws ConfigError or std::invalid_argument where a parameter is wrong.
  InsServer(const ros::NodeHandle& node, const ros::NodeHandle& own);

 private:
  struct Lane {
    std::string name;
    ros::Publisher odometry, fix, settled, update;
    OutputRate now_rate, settled_rate;
    std::deque<ins::NavigationSolution> solutions;  // settled, of the base, that wait to be published
    std::deque<ins::Audit> audits;
    std::array<std::uint64_t, 5> verdicts{};
    Stamp published = 0;
    double effective_size = 0;  // of the last settled update, see Audit
  };

  void startAnew();
  /// `take`: what the ingest does with a message.
  template <class Message>
  void subscribe(const std::string& topic, void (InsIngest::*take)(const Message&));
  /// A message's callback: `ingest` hands it on, and what follows from it is published.
  template <class Ingest>
  void receive(const Ingest& ingest);
  void publishNow(std::size_t lane);
  void queueSettled();
  void publishSettled(std::size_t most);
  void publishDatum();
  void onIdle(const ros::WallTimerEvent&);
  /// Of the base, from one of the INS.
  ins::Solution ofBase(const ins::NavigationSolution& solution) const { return movedBy(solution, ingest_->base_lever_body()); }
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  static void diagnoseParticles(const Lane& lane, diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseStart(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response);
  bool onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response);

  ros::NodeHandle node_, own_;
  InsSettings settings_;
  bool publish_tf_ = false;
  double idle_timeout_ = 3;  // a pause of the input after which what is open is settled [s, wall]
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<InsIngest> ingest_;
  std::unique_ptr<ins::LiveSession> session_;
  std::vector<std::string> names_;
  std::vector<Lane> lanes_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  ros::Publisher datum_publisher_;
  bool datum_published_ = false;
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer idle_timer_, diagnostic_timer_, settled_timer_;
  ros::WallTime last_message_;
  bool open_ = false;  // something is not settled
  LatencyMeter latency_, callback_;
};

}  // namespace sas_motion::ros_side
