// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/server.hpp"

#include "ros/serving.hpp"
#include "sas_motion/estimate/old_names.hpp"

namespace sas_motion::ros_side {
namespace {

// Settled answers published after a message at most: more than there are measurements in one.
constexpr std::size_t kWithEach = 4;

/// map -> odom, the identity since one estimate serves both, and odom -> base.
void broadcastPose(tf2_ros::TransformBroadcaster& broadcaster, const Solution& solution, const MapSettings& settings) {
  const ros::Time time = timeOf(solution.stamp);
  Transform T_map_base = Transform::Identity();
  T_map_base.translation() = solution.position_map;
  auto odom_to_base = stamped(settings.odom_frame, settings.base_frame, time, T_map_base);
  odom_to_base.transform.rotation = messageOf(solution.q_map_base);
  broadcaster.sendTransform(std::vector<geometry_msgs::TransformStamped>{
      stamped(settings.map_frame, settings.odom_frame, time, Transform::Identity()), odom_to_base});
}

}  // namespace

EstimatorServer::EstimatorServer(const ros::NodeHandle& node, const ros::NodeHandle& own, const Open& open, Kind kind)
    : node_(node), own_(own) {
  readParameters(open, kind);
  run_ = system_->begin(names_, transforms_, true);
  addLanes();
  if (with_batch_) batch_ = std::make_unique<BatchSolver>(node_, own_, *system_, transforms_);
  datum_publisher_ = node_.advertise<sensor_msgs::NavSatFix>("datum", 1, true);
  listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_, node_);
  subscribers_ = run_->subscribe(node_, [this](const SystemRun::Delivery& message) { onMessage(message); });
  advertiseServices();
  reconfigure_ = std::make_unique<Reconfigure>(own_, system_->tuning,
                                               [this](const Tuning& changed) { run_->session().configure(changed); });
  updater_ = makeUpdater(node_, own_, "estimators", this, &EstimatorServer::diagnose);
  diagnostic_timer_ =
      node_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { updater_->force_update(); });
  idle_timer_ = node_.createWallTimer(ros::WallDuration(0.5), &EstimatorServer::onIdle, this);
  settled_timer_ = node_.createWallTimer(ros::WallDuration(kBetweenBursts),
                                         [this](const ros::WallTimerEvent&) { publishSettled(kBurst); });
}

void EstimatorServer::readParameters(const Open& open, Kind kind) {
  std::string config;
  readParameter(own_, "config", config);
  system_ = open(config);
  for (auto& source : system_->sources) readParameter(own_, source.name + "_topic", source.topic);
  readParameter(own_, "publish_tf", publish_tf_);
  readParameter(own_, "idle_timeout", idle_timeout_);
  readParameter(own_, "batch", with_batch_);
  names_ = kind == Kind::Filters ? system_->preferred : system_->smoothers;
  readParameter(own_, "estimators", names_);
  for (const auto& sentence : replaceOldNames(names_, [this](const auto& name) { return system_->currentName(name); }))
    ROS_WARN_STREAM(sentence);
  try {
    system_->require(names_);
  } catch (const std::runtime_error& error) {
    throw ConfigError(fmt::format("~estimators: {}", error.what()));
  }
}

void EstimatorServer::addLanes() {
  for (const auto& name : names_) {
    lanes_.push_back({name, EstimatePublisher(node_, name, system_->has_current), {}, {}});
    if (system_->output_rate) lanes_.back().rate.emplace(*system_->output_rate);
  }
}

void EstimatorServer::onMessage(const SystemRun::Delivery& message) {
  const ros::WallTime begin = ros::WallTime::now();
  last_message_ = begin;
  open_ = true;
  message(*run_);
  run_->session().feed();
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) publishNow(lane);
  latency_.add((ros::WallTime::now() - begin).toSec());
  if (batch_) batch_->take(message);
  queueSettled();
  publishDatum();
  publishSettled(kWithEach);
  callback_.add((ros::WallTime::now() - begin).toSec());
}

void EstimatorServer::publishNow(std::size_t index) {
  Lane& lane = lanes_[index];
  const bool with_tf = publish_tf_ && index == 0;
  if (!with_tf && !lane.publisher.heard()) return;
  const auto now = run_->session().current(index, run_->frame());
  if (!now) return;
  const bool moved = now->stamp != lane.published;  // late data change the answer at a stamp, but tf keeps the first
  if (lane.rate && (!moved || !lane.rate->due(now->stamp))) return;
  lane.published = now->stamp;
  lane.publisher.publishNow(*now, system_->map);
  if (with_tf && moved) broadcastPose(broadcaster_, *now, system_->map);
}

void EstimatorServer::queueSettled() {
  Output output;
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    output.clear();
    run_->session().takeSettled(i, run_->frame(), output);
    lanes_[i].counts.add(output);
    lanes_[i].publisher.queue(output);
  }
}

void EstimatorServer::publishSettled(std::size_t most) {
  for (auto& lane : lanes_) lane.publisher.publishSettled(most, system_->map);
}

void EstimatorServer::publishDatum() {
  if (datum_published_ || !run_->frame().map) return;
  datum_publisher_.publish(fixAt(run_->frame().map->datum(), ros::Time::now(), system_->map.map_frame));
  datum_published_ = true;
}

void EstimatorServer::onIdle(const ros::WallTimerEvent&) {
  if (!open_ || (ros::WallTime::now() - last_message_).toSec() <= idle_timeout_) return;
  open_ = false;
  run_->session().finish();
  queueSettled();
  for (std::size_t i = 0; i < lanes_.size(); ++i) {  // a smoother runs behind its data until they pause
    const auto newest = run_->session().current(i, run_->frame());
    if (newest && newest->stamp != lanes_[i].published) publishNow(i);
  }
}

void EstimatorServer::startAnew() {
  run_->restart();
  for (auto& lane : lanes_) {
    lane.publisher.clear();  // it is of another start, and may be of another datum
    lane.counts = {};
    lane.published = 0;
  }
  if (batch_) batch_->restart();
  datum_published_ = false;
}

void EstimatorServer::diagnose(DiagnosticStatus& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "estimating");
  diagnoseRun(*run_, system_->map, status);
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    diagnoseLane(lanes_[i].name, lanes_[i].counts, run_->session().current(i, run_->frame()), status);
  diagnoseLatency(latency_, callback_, status);
}

}  // namespace sas_motion::ros_side
