// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/ros/estimator_server.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sas_motion/ros/estimate_messages.hpp"
#include "sas_motion/smoothers/factor_graph/estimators.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr std::uint32_t kQueue = 1000;  // messages kept for a slow callback or subscriber
// A whole recording at once would overrun its subscribers: rosbag record keeps 100 messages of a topic for its threads.
constexpr std::size_t kBurst = 25;      // messages of a topic published at once before a pause
constexpr double kPause = 0.05;         // [s]

geometry_msgs::TransformStamped mapToOdom(const Settings& settings, ros::Time stamp) {
  geometry_msgs::TransformStamped T;
  T.header.stamp = stamp;
  T.header.frame_id = settings.map_frame;
  T.child_frame_id = settings.odom_frame;
  T.transform.rotation.w = 1;  // one estimate serves both: map and odom coincide
  return T;
}

/// Replaces `value` by a private parameter where there is one.
template <class T>
void readParameter(const ros::NodeHandle& own, const std::string& key, T& value) {
  if (own.hasParam(key) && !own.getParam(key, value)) throw ConfigError(fmt::format("~{} is of the wrong type", key));
}

}  // namespace

EstimatorServer::EstimatorServer(ros::NodeHandle node, ros::NodeHandle own, const std::vector<std::string>& default_estimators) : node_(node), own_(own) {
  std::string config;
  bool with_batch = false;
  auto names = default_estimators;
  readParameter(own_, "config", config);
  settings_ = Settings::fromFile(config);
  readParameter(own_, "fix_topic", settings_.fix_topic);
  readParameter(own_, "imu_topic", settings_.imu_topic);
  readParameter(own_, "twist_topic", settings_.twist_topic);
  readParameter(own_, "publish_tf", publish_tf_);
  readParameter(own_, "idle_timeout", idle_timeout_);
  readParameter(own_, "batch", with_batch);
  readParameter(own_, "estimators", names);

  const auto lane = [&](const std::string& name) {
    Lane fresh;
    fresh.name = name;
    fresh.estimator = towfish::makeAnyEstimator(name, settings_.estimation);
    if (!fresh.estimator) throw ConfigError(fmt::format("~estimators: '{}' is no estimator; known are {}", name, fmt::join(towfish::estimatorNames(), ", ")));
    for (const char* topic : {"odometry", "settled"}) fresh.publishers[topic] = node_.advertise<nav_msgs::Odometry>(name + "/" + topic, kQueue);
    fresh.publishers["fix"] = node_.advertise<sensor_msgs::NavSatFix>(name + "/fix", kQueue);
    for (const char* topic : {"current", "settled_current"})
      fresh.publishers[topic] = node_.advertise<geometry_msgs::TwistWithCovarianceStamped>(name + "/" + topic, kQueue);
    fresh.publishers["update"] = node_.advertise<sas_motion::FilterUpdate>(name + "/update", kQueue);
    return fresh;
  };
  for (const auto& name : names) {
    if (std::count(names.begin(), names.end(), name) > 1) throw ConfigError(fmt::format("~estimators: '{}' is there twice; name each once", name));
    lanes_.push_back(lane(name));
  }
  if (with_batch) batch_ = std::make_unique<Lane>(lane("batch"));

  datum_publisher_ = node_.advertise<sensor_msgs::NavSatFix>("datum", 1, true);
  listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_, node_);
  startAnew();
  const auto hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(
      node_.subscribe<sensor_msgs::NavSatFix>(settings_.fix_topic, kQueue, &EstimatorServer::onMessage<sensor_msgs::NavSatFix>, this, hints));
  subscribers_.push_back(node_.subscribe<sensor_msgs::Imu>(settings_.imu_topic, kQueue, &EstimatorServer::onMessage<sensor_msgs::Imu>, this, hints));
  subscribers_.push_back(node_.subscribe<geometry_msgs::TwistWithCovarianceStamped>(
      settings_.twist_topic, kQueue, &EstimatorServer::onMessage<geometry_msgs::TwistWithCovarianceStamped>, this, hints));
  services_.push_back(own_.advertiseService("reset", &EstimatorServer::onReset, this));
  services_.push_back(own_.advertiseService("set_datum", &EstimatorServer::onSetDatum, this));
  services_.push_back(own_.advertiseService("get_state_at", &EstimatorServer::onGetStateAt, this));
  if (batch_) services_.push_back(own_.advertiseService("solve_batch", &EstimatorServer::onSolveBatch, this));

  updater_ = std::make_unique<diagnostic_updater::Updater>(node_, own_, own_.getNamespace());  // two nodelets of one manager are told apart
  updater_->setHardwareID("sas_motion");
  updater_->add("estimators", this, &EstimatorServer::diagnose);
  diagnostic_timer_ = node_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { updater_->force_update(); });
  idle_timer_ = node_.createWallTimer(ros::WallDuration(0.5), &EstimatorServer::onIdle, this);
}

template <class Message>
void EstimatorServer::onMessage(const boost::shared_ptr<Message const>& message) {
  const ros::WallTime begin = ros::WallTime::now();
  last_message_ = begin;
  ingest_->take(*message);
  publishDatum();
  for (auto& lane : lanes_) publishNow(lane);
  latency_.add((ros::WallTime::now() - begin).toSec());
}

void EstimatorServer::onMeasurement(const Measurement& z) {
  open_ = true;
  for (auto& lane : lanes_) {
    lane.estimator->process(z, output_);
    publishSettled(lane);
  }
  if (batch_) {
    batch_->estimator->process(z, output_);
    output_.clear();
  }
}

void EstimatorServer::publishNow(Lane& lane) {
  const auto estimate = lane.estimator->current();
  if (!estimate || estimate->stamp < lane.published) return;
  lane.published = estimate->stamp;
  lane.publishers["odometry"].publish(odometryOf(*estimate, settings_));
  lane.publishers["current"].publish(currentOf(*estimate, settings_));
  if (ingest_->frame()) lane.publishers["fix"].publish(fixOf(*estimate, *ingest_->frame(), settings_));
  if (publish_tf_ && &lane == &lanes_.front()) broadcast(*estimate);
}

void EstimatorServer::publishSettled(Lane& lane) {
  const auto& [estimates, audits] = output_;
  for (std::size_t i = 0; i < std::max(estimates.size(), audits.size()); ++i) {
    if (i < audits.size()) {
      ++lane.verdicts[static_cast<std::size_t>(audits[i].verdict)];
      lane.publishers["update"].publish(updateOf(audits[i]));
    }
    if (i < estimates.size()) {
      lane.publishers["settled"].publish(odometryOf(estimates[i], settings_));
      lane.publishers["settled_current"].publish(currentOf(estimates[i], settings_));
    }
    if (i % kBurst == kBurst - 1) ros::WallDuration(kPause).sleep();
  }
  output_.clear();
}

void EstimatorServer::broadcast(const Estimate& estimate) {
  const auto odometry = odometryOf(estimate, settings_);
  geometry_msgs::TransformStamped T;
  T.header.stamp = odometry.header.stamp;
  T.header.frame_id = settings_.odom_frame;
  T.child_frame_id = settings_.base_frame;
  T.transform.translation.x = odometry.pose.pose.position.x;
  T.transform.translation.y = odometry.pose.pose.position.y;
  T.transform.rotation = odometry.pose.pose.orientation;
  broadcaster_.sendTransform(std::vector<geometry_msgs::TransformStamped>{mapToOdom(settings_, T.header.stamp), T});
}

void EstimatorServer::publishDatum() {
  if (datum_published_ || !ingest_->frame()) return;
  datum_publisher_.publish(datumOf(*ingest_->frame(), settings_, ros::Time::now()));
  datum_published_ = true;
}

void EstimatorServer::onIdle(const ros::WallTimerEvent&) {
  if (open_ && (ros::WallTime::now() - last_message_).toSec() > idle_timeout_) settleAll();
}

void EstimatorServer::settleAll() {
  open_ = false;
  for (auto& lane : lanes_) {
    lane.estimator->finish(output_);
    publishSettled(lane);
    const auto newest = lane.estimator->current();
    if (newest && newest->stamp > lane.published) publishNow(lane);  // a smoother runs behind its data until they pause
  }
}

void EstimatorServer::startAnew() {
  const auto frame = ingest_ ? ingest_->frame() : std::nullopt;
  ingest_ = std::make_unique<Ingest>(settings_, transforms_, [this](const Measurement& z) { onMeasurement(z); });
  if (frame) ingest_->setDatum(frame->datum());
  for (auto& lane : lanes_) {
    lane.estimator->reset();
    lane.published = 0;
    lane.verdicts.fill(0);
  }
  if (batch_) batch_->estimator->reset();
  datum_published_ = false;
}

bool EstimatorServer::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  startAnew();
  response.success = true;
  response.message = "estimators start anew";
  return true;
}

bool EstimatorServer::onSetDatum(SetDatum::Request& request, SetDatum::Response& response) {
  try {
    const LocalFrame frame({request.latitude, request.longitude, request.altitude});
    settings_.datum = frame.datum();
    startAnew();
    ingest_->setDatum(frame.datum());
    publishDatum();
    response.success = true;
    response.message = "datum set, estimators start anew";
  } catch (const std::invalid_argument& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

bool EstimatorServer::onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response) {
  response.success = false;
  response.message = "no such estimator";
  for (const auto& lane : lanes_) {
    if (!request.estimator.empty() && request.estimator != lane.name) continue;
    const auto estimate = lane.estimator->at(stampOf(request.stamp));
    response.success = estimate.has_value();
    response.message = estimate ? "" : "the stamp is older than the lag, or the estimator has not started or keeps no history";
    if (estimate) {
      response.odometry = odometryOf(*estimate, settings_);
      response.current = currentOf(*estimate, settings_);
    }
    break;
  }
  return true;
}

bool EstimatorServer::onSolveBatch(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  settleAll();
  const ros::WallTime begin = ros::WallTime::now();
  batch_->estimator->finish(output_);
  const double seconds = (ros::WallTime::now() - begin).toSec();
  const std::size_t states = output_.estimates.size();
  publishSettled(*batch_);
  response.success = states > 0;
  response.message = states > 0 ? fmt::format("{} states in {:.2f} s", states, seconds) : "nothing solved: " + batch_->estimator->failure();
  return true;
}

}  // namespace sas_motion::ros_side
