// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/ins_server.hpp"

#include <algorithm>

#include "systems/ins_gps_dvl/ros/remarks.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kFewParticles = 5;  // of which fewer say nothing of how sure they are

}  // namespace

InsServer::InsServer(const ros::NodeHandle& node, const ros::NodeHandle& own) : node_(node), own_(own) {
  std::string config;
  readParameter(own_, "config", config);
  settings_ = InsSettings::fromFile(config);
  readParameter(own_, "fix_topic", settings_.fix_topic);
  readParameter(own_, "imu_topic", settings_.imu_topic);
  readParameter(own_, "twist_topic", settings_.twist_topic);
  readParameter(own_, "depth_topic", settings_.depth_topic);
  readParameter(own_, "velocity_topic", settings_.velocity_topic);
  readParameter(own_, "publish_tf", publish_tf_);
  readParameter(own_, "idle_timeout", idle_timeout_);
  names_ = {settings_.preferred};
  readParameter(own_, "estimators", names_);
  const auto& known = settings_.estimators;
  for (const auto& name : names_) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw ConfigError(fmt::format("~estimators: '{}' is no estimator; known are {}", name, fmt::join(known, ", ")));
    if (std::count(names_.begin(), names_.end(), name) > 1)
      throw ConfigError(fmt::format("~estimators: '{}' is there twice; name each once", name));
    const OutputRate rate(settings_.estimation.output_rate);
    lanes_.push_back({name,
                      node_.advertise<nav_msgs::Odometry>(name + "/odometry", kQueue),
                      node_.advertise<sensor_msgs::NavSatFix>(name + "/fix", kQueue),
                      node_.advertise<nav_msgs::Odometry>(name + "/settled", kQueue),
                      node_.advertise<FilterUpdate>(name + "/update", kQueue),
                      rate,
                      rate,
                      {},
                      {}});
  }
  datum_publisher_ = node_.advertise<sensor_msgs::NavSatFix>("datum", 1, true);
  listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_, node_);
  startAnew();
  subscribe<sensor_msgs::Imu>(settings_.imu_topic, &InsIngest::take);
  subscribe<sensor_msgs::NavSatFix>(settings_.fix_topic, &InsIngest::take);
  subscribe<geometry_msgs::TwistWithCovarianceStamped>(settings_.twist_topic, &InsIngest::take);
  subscribe<geometry_msgs::PoseWithCovarianceStamped>(settings_.depth_topic, &InsIngest::take);
  if (!settings_.velocity_topic.empty())
    subscribe<geometry_msgs::TwistWithCovarianceStamped>(settings_.velocity_topic, &InsIngest::takeVelocity);
  services_ = {own_.advertiseService("reset", &InsServer::onReset, this),
               own_.advertiseService("enable_sensor", &InsServer::onEnableSensor, this),
               own_.advertiseService("get_state_at", &InsServer::onGetStateAt, this)};

  updater_ = std::make_unique<diagnostic_updater::Updater>(node_, own_, own_.getNamespace());
  updater_->setHardwareID("sas_motion");
  updater_->add("estimators", this, &InsServer::diagnose);
  diagnostic_timer_ =
      node_.createWallTimer(ros::WallDuration(1), [this](const ros::WallTimerEvent&) { updater_->force_update(); });
  idle_timer_ = node_.createWallTimer(ros::WallDuration(0.5), &InsServer::onIdle, this);
  settled_timer_ = node_.createWallTimer(ros::WallDuration(kBetweenBursts),
                                         [this](const ros::WallTimerEvent&) { publishSettled(kBurst); });
}

template <class Message>
void InsServer::subscribe(const std::string& topic, void (InsIngest::*take)(const Message&)) {
  const boost::function<void(const boost::shared_ptr<Message const>&)> onMessage =
      [this, take](const boost::shared_ptr<Message const>& message) { receive([&] { (*ingest_.*take)(*message); }); };
  subscribers_.push_back(node_.subscribe<Message>(topic, kQueue, onMessage, {}, ros::TransportHints().tcpNoDelay()));
}

void InsServer::startAnew() {
  session_ = std::make_unique<ins::LiveSession>(settings_.estimation.session, names_, settings_.make);
  auto fresh = std::make_unique<InsIngest>(settings_, transforms_,
                                           [this](const ins::Reading& reading) { session_->process(reading); });
  if (ingest_) {
    if (ingest_->frame()) fresh->setDatum(ingest_->frame()->datum());
    for (std::size_t i = 0; i < InsIngest::kSources; ++i) fresh->inbox().enable(i, ingest_->inbox().enabled(i));
  }
  ingest_ = std::move(fresh);
  for (auto& lane : lanes_) {
    lane.solutions.clear();
    lane.audits.clear();
    lane.verdicts.fill(0);
    lane.published = 0;
    lane.effective_size = 0;
  }
}

template <class Ingest>
void InsServer::receive(const Ingest& ingest) {
  const ros::WallTime begin = ros::WallTime::now();
  last_message_ = begin;
  open_ = true;
  ingest();
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) publishNow(lane);
  latency_.add((ros::WallTime::now() - begin).toSec());
  queueSettled();
  publishDatum();
  publishSettled(kWithEach);
  callback_.add((ros::WallTime::now() - begin).toSec());
}

void InsServer::publishNow(std::size_t index) {
  Lane& lane = lanes_[index];
  const auto& now = session_->current(index);
  if (!now || now->stamp == lane.published || !ingest_->frame() || !lane.now_rate.due(now->stamp)) return;
  lane.published = now->stamp;
  const ins::NavigationSolution base = ofBase(*now);
  const bool with_tf = publish_tf_ && index == 0;
  if (with_tf || lane.odometry.getNumSubscribers() > 0) {
    const auto odometry = odometryOf(base, *ingest_->frame(), settings_);
    publishTo(lane.odometry, [&] { return odometry; });
    if (with_tf) broadcastPose(broadcaster_, odometry, settings_);
  }
  publishTo(lane.fix, [&] { return fixOf(base, settings_); });
}

void InsServer::queueSettled() {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    Lane& lane = lanes_[i];
    ins::Output& output = session_->session().lanes()[i].output;
    for (const auto& solution : output.solutions)
      if (lane.settled_rate.due(solution.stamp)) lane.solutions.push_back(ofBase(solution));
    for (const auto& audit : output.audits) {
      ++lane.verdicts[static_cast<std::size_t>(audit.verdict)];
      if (audit.effective_size > 0) lane.effective_size = audit.effective_size;
      lane.audits.push_back(audit);
    }
    output.clear();
  }
}

void InsServer::publishSettled(std::size_t most) {
  for (auto& lane : lanes_) {
    for (std::size_t i = 0; i < most && !lane.audits.empty(); ++i, lane.audits.pop_front())
      publishTo(lane.update, [&] { return updateOf(lane.audits.front()); });
    for (std::size_t i = 0; i < most && !lane.solutions.empty(); ++i, lane.solutions.pop_front())
      publishTo(lane.settled, [&] { return odometryOf(lane.solutions.front(), *ingest_->frame(), settings_); });
  }
}

void InsServer::publishDatum() {
  if (datum_published_ || !ingest_->frame()) return;
  datum_publisher_.publish(datumOf(*ingest_->frame(), settings_, ros::Time::now()));
  datum_published_ = true;
}

void InsServer::onIdle(const ros::WallTimerEvent&) {
  if (!open_ || (ros::WallTime::now() - last_message_).toSec() <= idle_timeout_) return;
  open_ = false;
  session_->finish();
  queueSettled();
}

void InsServer::diagnoseStart(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string waiting = whyNotStarted(session_->session().alignment(), settings_);
  status.add("start", waiting.empty() ? "started" : "waiting: " + waiting);
  if (!waiting.empty())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "the INS has not started: " + waiting);
}

void InsServer::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "estimating");
  diagnoseSources(ingest_->inbox(), InsIngest::kNames, settings_, status);
  diagnoseStart(status);
  const auto& inertial = session_->session().inertial();
  status.addf("imu rate [1/s]", "%.2f", inertial.mean_period > 0 ? 1 / inertial.mean_period : 0);
  const auto& of = inertial.verdicts;
  status.addf("imu integrated, off its rate, over gaps, out of order, implausible", "%lu, %lu, %lu, %lu, %lu", of[1],
              of[2], of[3], of[4], of[5]);
  for (const auto& remark : remarksOn(inertial, ingest_->inbox(), settings_))
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, remark);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    diagnoseVerdicts(lanes_[i].name, lanes_[i].verdicts, status);
    diagnoseParticles(lanes_[i], status);
    const auto& now = session_->current(i);
    if (!now || !now->covariance) continue;
    const auto variance = now->covariance->diagonal().segment<2>(ins::kPosition);
    status.addf(lanes_[i].name + " 2-sigma position [m]", "%.3f", 2 * std::sqrt(variance.sum()));
  }
  diagnoseLatency(latency_, callback_, status);
}

void InsServer::diagnoseParticles(const Lane& lane, diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!(lane.effective_size > 0)) return;
  status.addf(lane.name + " effective particles", "%.0f", lane.effective_size);
  if (lane.effective_size < kFewParticles)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        lane.name + " has next to all weight on a few particles; its covariance is not to be trusted");
}

bool InsServer::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  startAnew();
  response.success = true;
  response.message = "estimators start anew";
  return true;
}

bool InsServer::onEnableSensor(EnableSensor::Request& request, EnableSensor::Response& response) {
  return enableSensor(
      InsIngest::kNames, [this](std::size_t source, bool enabled) { ingest_->inbox().enable(source, enabled); },
      request, response);
}

bool InsServer::onGetStateAt(GetStateAt::Request& request, GetStateAt::Response& response) {
  const auto found =
      request.estimator.empty() ? names_.begin() : std::find(names_.begin(), names_.end(), request.estimator);
  response.success = false;
  response.message = "no such estimator";
  if (found == names_.end()) return true;
  const auto solution = session_->at(static_cast<std::size_t>(found - names_.begin()), stampOf(request.stamp));
  response.success = solution && ingest_->frame();
  response.message =
      response.success
          ? ""
          : "the stamp is older than the lag or far ahead, or the estimator has not started or keeps no present state";
  if (response.success) response.odometry = odometryOf(ofBase(*solution), *ingest_->frame(), settings_);
  return true;
}

}  // namespace sas_motion::ros_side
