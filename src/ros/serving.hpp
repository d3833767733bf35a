// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fmt/format.h>
#include <ros/ros.h>
#include <sas_motion/EnableSensor.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <string>

#include "ros/inbox.hpp"
#include "ros/latency.hpp"
#include "sas_motion/config/yaml_section.hpp"

/// What the servers behind the nodelets share.
namespace sas_motion::ros_side {

constexpr std::uint32_t kQueue = 1000;  // messages kept for a slow callback or subscriber
// A whole recording at once would overrun its subscribers: rosbag record keeps 100 messages of a topic.
constexpr std::size_t kBurst = 25;       // messages of a topic at once
constexpr double kBetweenBursts = 0.05;  // [s]
constexpr std::size_t kWithEach =
    4;  // settled answers published after a message at most: more than there are measurements in one

/// Replaces `value` by a private parameter where there is one. Throws ConfigError.
template <class T>
void readParameter(const ros::NodeHandle& own, const std::string& key, T& value) {
  if (own.hasParam(key) && !own.getParam(key, value)) throw ConfigError(fmt::format("~{} is of the wrong type", key));
}

/// Publishes make() where somebody listens; by pointer, so that a nodelet of the same manager gets it without a copy.
template <class Make>
void publishTo(const ros::Publisher& publisher, const Make& make) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<std::decay_t<decltype(make())>>(make()));
}

/// map -> odom, the identity since one estimate serves both, and odom -> base.
void broadcastPose(tf2_ros::TransformBroadcaster& broadcaster, const nav_msgs::Odometry& odometry,
                   const MapSettings& settings);

/// Answers ~enable_sensor by enable(index, bool) of the sensors of these names.
template <class Names, class Enable>
bool enableSensor(const Names& names, const Enable& enable, const EnableSensor::Request& request,
                  EnableSensor::Response& response) {
  const auto found = std::find(names.begin(), names.end(), request.sensor);
  response.success = found != names.end();
  response.message =
      response.success ? "" : fmt::format("'{}' is no sensor; known are {}", request.sensor, fmt::join(names, ", "));
  if (response.success) enable(static_cast<std::size_t>(found - names.begin()), request.enabled);
  return true;
}

// What they say on /diagnostics.
using DiagnosticStatus = diagnostic_updater::DiagnosticStatusWrapper;
/// Of each source messages, losses, and age; what is silent, disabled, or of an unknown frame.
template <class Names>
void diagnoseSources(const Inbox& inbox, const Names& names, const MapSettings& settings, DiagnosticStatus& status);
void diagnoseSource(const MessageCounts& counts, bool enabled, const std::string& name, Stamp newest,
                    const MapSettings& settings, DiagnosticStatus& status);
/// `verdicts` are counts by Verdict.
void diagnoseVerdicts(const std::string& estimator, const std::array<std::uint64_t, 5>& verdicts,
                      DiagnosticStatus& status);
void diagnoseLatency(const LatencyMeter& latency, const LatencyMeter& callback, DiagnosticStatus& status);

template <class Names>
void diagnoseSources(const Inbox& inbox, const Names& names, const MapSettings& settings, DiagnosticStatus& status) {
  Stamp newest = 0;
  for (std::size_t source = 0; source < names.size(); ++source) newest = std::max(newest, inbox.counts(source).newest);
  if (newest == 0) status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "no data yet");
  for (std::size_t source = 0; source < names.size(); ++source)
    diagnoseSource(inbox.counts(source), inbox.enabled(source), names[source], newest, settings, status);
}

}  // namespace sas_motion::ros_side
