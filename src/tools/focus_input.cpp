// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/focus_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "bag/bag_reader.hpp"
#include "bag/topics.hpp"
#include <nav_msgs/Odometry.h>

#include "ros/messages.hpp"
#include "sas_motion/estimate/solution.hpp"

namespace sas_motion {

using namespace ros_side;
using imaging::TimedPose;

namespace {

const std::string kTruth = "truth/odometry", kLeaf = "/odometry";

std::optional<TimedPose> poseOf(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  TimedPose pose{stampOf(odometry.header.stamp), {p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}};
  if (!pose.position.allFinite() || !(pose.q_local_body.norm() > 0.5)) return std::nullopt;
  pose.q_local_body.normalize();
  return pose;
}

/// The bare names of all odometry topics, in order.
std::set<std::string> odometryTopics(const BagReader& bag) {
  std::set<std::string> topics;
  for (const auto& connection : bag.connections())
    if (connection.type == "nav_msgs/Odometry") topics.insert(bareTopic(connection.topic));
  return topics;
}

bool isNamed(const std::string& topic) {
  return topic.size() > kLeaf.size() && topic.compare(topic.size() - kLeaf.size(), kLeaf.size(), kLeaf) == 0;
}

/// Truth first.
std::vector<std::string> chosenTopics(const std::string& file, const std::set<std::string>& there,
                                      const std::vector<std::string>& wanted) {
  if (!there.count(kTruth))
    throw std::runtime_error(
        fmt::format("{}: no topic {}; an image needs the true track to be simulated on", file, kTruth));
  std::vector<std::string> topics{kTruth};
  if (wanted.empty())
    std::copy_if(there.begin(), there.end(), std::back_inserter(topics),
                 [](const auto& topic) { return isNamed(topic) && topic != kTruth; });
  for (const auto& name : wanted) {
    const std::string bare = bareTopic(name), topic = there.count(bare) ? bare : bare + kLeaf;
    if (!there.count(topic))
      throw std::runtime_error(fmt::format("{}: no trajectory {}; there are {}", file, name, fmt::join(there, ", ")));
    if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
  }
  return topics;
}

/// What the images of a topic are called.
std::string fileName(const std::string& topic) {
  std::string name = isNamed(topic) ? topic.substr(0, topic.size() - kLeaf.size()) : topic;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::vector<RecordedTrajectory> named(const std::string& file, const std::vector<std::string>& topics) {
  std::vector<RecordedTrajectory> trajectories;
  std::set<std::string> names{"focus"};  // focus.json and focus.png are the summary's
  for (const auto& topic : topics) {
    trajectories.push_back({fileName(topic), topic, {}});
    if (!names.insert(trajectories.back().name).second)
      throw std::runtime_error(
          fmt::format("{}: the files of {} would take another's name, {}; choose topics with --trajectory", file, topic,
                      trajectories.back().name));
  }
  return trajectories;
}

/// Where a fix of the truth and an odometry of the same stamp show that truth's frame has another origin than the
/// estimates'.
struct Origins {
  std::optional<LocalFrame> datum;
  std::map<Stamp, Geodetic> fixes;
  bool heights = false;  // the truth has heights: the others do too

  Eigen::Vector3d shiftOf(const std::vector<TimedPose>& truth) const {
    if (!datum) return Eigen::Vector3d::Zero();
    for (const auto& pose : truth)
      if (const auto fix = fixes.find(pose.stamp); fix != fixes.end()) {
        const Eigen::Vector3d shift = datum->position_enu(fix->second) - pose.position;
        return {shift.x(), shift.y(), heights ? shift.z() : 0};
      }
    return Eigen::Vector3d::Zero();
  }
};

}  // namespace

std::vector<RecordedTrajectory> readTrajectories(const std::string& file, const std::vector<std::string>& wanted) {
  BagReader bag(file);
  auto trajectories = named(file, chosenTopics(file, odometryTopics(bag), wanted));
  std::map<std::string, std::vector<TimedPose>> poses;
  for (const auto& trajectory : trajectories) poses[trajectory.topic];
  Origins origins;
  nav_msgs::Odometry odometry;
  sensor_msgs::NavSatFix fix;
  while (const BagMessage* message = bag.next()) {
    const std::string topic = bareTopic(message->connection->topic);
    if (const auto found = poses.find(topic); found != poses.end() && bag.get(*message, odometry)) {
      if (const auto pose = poseOf(odometry)) found->second.push_back(*pose);
      if (topic == kTruth) origins.heights = odometry.pose.covariance[14] < kNotEstimated;
    } else if (topic == "datum" && !origins.datum && bag.get(*message, fix)) {
      origins.datum.emplace(geodeticOf(fix));
    } else if (topic == "truth/fix" && origins.fixes.size() < 100 && bag.get(*message, fix) && hasPosition(fix)) {
      origins.fixes[stampOf(fix.header.stamp)] = geodeticOf(fix);
    }
  }
  auto& truth = poses[kTruth];
  const Eigen::Vector3d shift = origins.shiftOf(truth);
  for (auto& pose : truth) pose.position += shift;
  for (auto& trajectory : trajectories) trajectory.trajectory = imaging::Trajectory(std::move(poses[trajectory.topic]));
  return trajectories;
}

}  // namespace sas_motion
