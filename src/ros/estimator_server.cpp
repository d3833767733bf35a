// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/estimator_server.hpp"

#include <fmt/format.h>

#include "systems/towfish/graph/estimators.hpp"

namespace sas_motion::ros_side {

EstimatorServer::EstimatorServer(const ros::NodeHandle& node, const ros::NodeHandle& own,
                                 const std::vector<std::string>& default_estimators)
    : node_(node), own_(own) {
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

  for (const auto& name : names) addLane(name);
  if (with_batch) batch_ = std::make_unique<BatchSolver>(node_, own_, settings_);

  datum_publisher_ = node_.advertise<sensor_msgs::NavSatFix>("datum", 1, true);
  listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_, node_);
  startAnew();
  const auto hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(node_.subscribe<sensor_msgs::NavSatFix>(
      settings_.fix_topic, kQueue, &EstimatorServer::onMessage<sensor_msgs::NavSatFix>, this, hints));
  subscribers_.push_back(node_.subscribe<sensor_msgs::Imu>(settings_.imu_topic, kQueue,
                                                           &EstimatorServer::onMessage<sensor_msgs::Imu>, this, hints));
  subscribers_.push_back(node_.subscribe<geometry_msgs::TwistWithCovarianceStamped>(
      settings_.twist_topic, kQueue, &EstimatorServer::onMessage<geometry_msgs::TwistWithCovarianceStamped>, this,
      hints));
  advertiseServices();
  reconfigure_ = std::make_unique<Reconfigure>(own_, settings_.estimation, [this](const towfish::Config& changed) {
    for (auto& lane : lanes_) lane.estimator->configure(changed);
  });

  updater_ = std::make_unique<diagnostic_updater::Updater>(
      node_, own_, own_.getNamespace());  // two nodelets of one manager are told apart
  updater_->setHardwareID("sas_motion");
  updater_->add("estimators", this, &EstimatorServer::diagnose);
  diagnostic_timer_ =
      node_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { updater_->force_update(); });
  idle_timer_ = node_.createWallTimer(ros::WallDuration(0.5), &EstimatorServer::onIdle, this);
  settled_timer_ = node_.createWallTimer(ros::WallDuration(kBetweenBursts),
                                         [this](const ros::WallTimerEvent&) { publishSettled(kBurst); });
}

void EstimatorServer::addLane(const std::string& name) {
  auto estimator = towfish::makeAnyEstimator(name, settings_.estimation);
  if (!estimator)
    throw ConfigError(fmt::format("~estimators: '{}' is no estimator; known are {}", name,
                                  fmt::join(towfish::estimatorNames(), ", ")));
  for (const auto& lane : lanes_)
    if (lane.name == name) throw ConfigError(fmt::format("~estimators: '{}' is there twice; name each once", name));
  lanes_.push_back({name, std::move(estimator), EstimatePublisher(node_, name)});
}

template <class Message>
void EstimatorServer::onMessage(const boost::shared_ptr<Message const>& message) {
  const ros::WallTime begin = ros::WallTime::now();
  last_message_ = begin;
  ingest_->take(*message);
  for (auto& lane : lanes_) publishNow(lane);
  latency_.add((ros::WallTime::now() - begin).toSec());
  publishDatum();
  publishSettled(kWithEach);
  callback_.add((ros::WallTime::now() - begin).toSec());
}

void EstimatorServer::onMeasurement(const Measurement& z) {
  open_ = true;
  for (auto& lane : lanes_) {
    lane.estimator->process(z, output_);
    queueSettled(lane);
  }
  if (batch_) batch_->take(z);
}

void EstimatorServer::publishNow(Lane& lane) {
  const auto estimate = lane.estimator->current();
  if (!estimate) return;
  lane.publisher.publishNow(*estimate, ingest_->frame() ? &*ingest_->frame() : nullptr, settings_);
  const bool moved =
      estimate->stamp != lane.published;  // late data change the answer at a stamp, but tf keeps the first
  lane.published = estimate->stamp;
  if (publish_tf_ && moved && &lane == &lanes_.front())
    broadcastPose(broadcaster_, odometryOf(*estimate, settings_), settings_);
}

void EstimatorServer::queueSettled(Lane& lane) {
  for (const auto& audit : output_.audits) ++lane.verdicts[static_cast<std::size_t>(audit.verdict)];
  lane.publisher.queue(output_);
}

void EstimatorServer::publishSettled(std::size_t most) {
  for (auto& lane : lanes_) lane.publisher.publishSettled(most, settings_);
}

void EstimatorServer::publishDatum() {
  if (datum_published_ || !ingest_->frame()) return;
  datum_publisher_.publish(datumOf(*ingest_->frame(), settings_, ros::Time::now()));
  datum_published_ = true;
}

void EstimatorServer::onIdle(const ros::WallTimerEvent&) {
  if (!open_ || (ros::WallTime::now() - last_message_).toSec() <= idle_timeout_) return;
  open_ = false;
  for (auto& lane : lanes_) {
    lane.estimator->finish(output_);
    queueSettled(lane);
    const auto newest = lane.estimator->current();
    if (newest && newest->stamp != lane.published)
      publishNow(lane);  // a smoother runs behind its data until they pause
  }
}

void EstimatorServer::startAnew() {
  const auto frame = ingest_ ? ingest_->frame() : std::nullopt;
  auto fresh = std::make_unique<Ingest>(settings_, transforms_, [this](const Measurement& z) { onMeasurement(z); });
  if (frame) fresh->setDatum(frame->datum());
  for (int i = 0; ingest_ && i < Ingest::kSources; ++i)
    fresh->enable(static_cast<Ingest::Source>(i), ingest_->enabled(static_cast<Ingest::Source>(i)));
  ingest_ = std::move(fresh);
  for (auto& lane : lanes_) {
    lane.estimator->reset();
    lane.publisher.clear();  // it is of another start, and may be of another datum
    lane.published = 0;
    lane.verdicts.fill(0);
  }
  if (batch_) batch_->reset();
  datum_published_ = false;
}

}  // namespace sas_motion::ros_side
