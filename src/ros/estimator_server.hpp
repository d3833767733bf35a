// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sas_motion/EnableSensor.h>
#include <sas_motion/GetStateAt.h>
#include <sas_motion/SetDatum.h>
#include <sas_motion/SetState.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/batch_solver.hpp"
#include "ros/estimate_publisher.hpp"
#include "ros/reconfigure.hpp"
#include "ros/serving.hpp"
#include "systems/towfish/ros/ingest.hpp"

namespace sas_motion::ros_side {

/// Estimators behind ROS topics: the body of both nodelets. Fed with sensor messages it publishes, for each estimator
/// NAME,
///   NAME/odometry, NAME/fix, NAME/current             the best answer now, after every measurement
///   NAME/settled, NAME/settled_current, NAME/update   each stamp's final answer and the audit, once no late data can
///   change them
/// and /diagnostics, the datum, and tf of the first estimator. All callbacks run on one queue, and none
/// of them sleeps.
class EstimatorServer {
 public:
  /// Throws ConfigError or std::invalid_argument where a parameter is wrong.
  EstimatorServer(const ros::NodeHandle& node, const ros::NodeHandle& own,
                  const std::vector<std::string>& default_estimators);

 private:
  struct Lane {
    std::string name;
    std::unique_ptr<towfish::Estimator> estimator;
    EstimatePublisher publisher;
    std::array<std::uint64_t, 5> verdicts{};
    Stamp published = 0;
  };

  void addLane(const std::string& name);
  void advertiseServices();
  template <class Message>
  void onMessage(const boost::shared_ptr<Message const>& message);
  void onMeasurement(const Measurement& z);
  void publishNow(Lane& lane);
  void queueSettled(Lane& lane);
  void publishSettled(std::size_t most);
  void publishDatum();
  void onIdle(const ros::WallTimerEvent&);
  void startAnew();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseLane(const Lane& lane, diagnostic_updater::DiagnosticStatusWrapper& status);
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool onSetDatum(SetDatum::Request& request, SetDatum::Response& response);
  bool onSetState(SetState::Request& request, SetState::Response& response);
  bool onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response);
  bool onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response);
  std::string setState(Lane& lane, Estimate state);

  ros::NodeHandle node_, own_;
  Settings settings_;
  bool publish_tf_ = false;
  double idle_timeout_ = 3;  // a pause of the input after which what is open is settled [s, wall]
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<Ingest> ingest_;
  std::vector<Lane> lanes_;
  std::unique_ptr<BatchSolver> batch_;
  std::unique_ptr<Reconfigure> reconfigure_;
  towfish::Output output_;
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
