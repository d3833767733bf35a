// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sas_motion/EnableSensor.h>
#include <sas_motion/GetStateAt.h>
#include <sas_motion/SetDatum.h>
#include <sas_motion/SetState.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "ros/batch_solver.hpp"
#include "ros/diagnostics.hpp"
#include "ros/publisher.hpp"
#include "ros/reconfigure.hpp"
#include "sas_motion/session/output_rate.hpp"

namespace sas_motion::ros_side {

/// The estimators of a system behind ROS topics: the body of every nodelet that estimates motion. Fed with sensor
/// messages it publishes, for each estimator NAME,
///   NAME/odometry, NAME/fix, NAME/current             the best answer now, after every message or at the output rate
///   NAME/settled, NAME/settled_current, NAME/update   each stamp's final answer and the audit, once no late data can
///                                                     change them
/// (the current where the system estimates one) and /diagnostics, the datum, and tf of the first estimator. All
/// callbacks run on one queue, and none of them sleeps.
class EstimatorServer {
 public:
  using Open = std::function<std::unique_ptr<System>(const std::string& config)>;
  enum class Kind { Filters, Smoothers };

  /// `open` opens the system of ~config. Throws ConfigError or std::invalid_argument where a parameter is wrong.
  EstimatorServer(const ros::NodeHandle& node, const ros::NodeHandle& own, const Open& open, Kind kind);

 private:
  struct Lane {
    std::string name;
    EstimatePublisher publisher;
    std::optional<OutputRate> rate;  // of present answers
    LaneCounts counts;
    Stamp published = 0;
  };

  void readParameters(const Open& open, Kind kind);
  void addLanes();
  void advertiseServices();
  void onMessage(const SystemRun::Delivery& message);
  void publishNow(std::size_t lane);
  void queueSettled();
  void publishSettled(std::size_t most);
  void publishDatum();
  void onIdle(const ros::WallTimerEvent&);
  void startAnew();
  void diagnose(DiagnosticStatus& status);
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool onSetDatum(SetDatum::Request& request, SetDatum::Response& response);
  bool onSetState(SetState::Request& request, SetState::Response& response);
  bool onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response);
  bool onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response);

  ros::NodeHandle node_, own_;
  std::unique_ptr<System> system_;
  std::vector<std::string> names_;
  bool publish_tf_ = false, with_batch_ = false;
  double idle_timeout_ = 3;  // a pause of the input after which what is open is settled [s, wall]
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<SystemRun> run_;
  std::vector<Lane> lanes_;
  std::unique_ptr<BatchSolver> batch_;
  std::unique_ptr<Reconfigure> reconfigure_;
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
