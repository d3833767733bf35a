// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "bag/answer_topics.hpp"
#include "ros/solution_messages.hpp"
#include "tools/focus_steps.hpp"

namespace sas_motion {

using namespace ros_side;
using imaging::TimedPose;

namespace {

const std::string kTruth = "truth/odometry";

std::optional<TimedPose> poseOf(const Solution& solution) {
  TimedPose pose{solution.stamp, solution.position_map, solution.q_map_base};
  if (!pose.position.allFinite() || !(pose.q_local_body.norm() > 0.5)) return std::nullopt;
  pose.q_local_body.normalize();
  return pose;
}

/// The NAME of NAME/odometry or NAME/settled; empty for another topic.
std::string nameOf(const std::string& topic) {
  const std::string name = nameBefore("odometry", topic);
  return name.empty() ? nameBefore("settled", topic) : name;
}

/// The topics to read, truth first.
std::vector<std::string> chosenTopics(const std::string& file, const std::set<std::string>& there,
                                      const std::vector<std::string>& wanted) {
  if (!there.count(kTruth))
    throw std::runtime_error(
        fmt::format("{}: no topic {}; an image needs the true track to be simulated on", file, kTruth));
  std::vector<std::string> topics{kTruth}, names = wanted;
  if (wanted.empty())
    for (const auto& topic : there)
      if (const std::string name = nameOf(topic); !name.empty()) names.push_back(name);
  for (const auto& name : names) {
    const std::string bare = bareTopic(name), topic = there.count(bare) ? bare : solutionTopic(there, bare);
    if (!there.count(topic))
      throw std::runtime_error(fmt::format("{}: no trajectory {}; there are {}", file, name, fmt::join(there, ", ")));
    if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
  }
  return topics;
}

/// The name of the images of a topic.
std::string fileName(const std::string& topic) {
  std::string name = nameOf(topic).empty() ? topic : nameOf(topic);
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

/// Shift from the truth's frame to the estimates', from a fix and an odometry of the truth with the same stamp.
struct Origins {
  std::optional<LocalFrame> datum;
  std::map<Stamp, Geodetic> fixes;
  bool heights = false;  // whether the truth has heights

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
  TopicReader reader(bag);
  auto trajectories = named(file, chosenTopics(file, topicsOf(bag, "nav_msgs/Odometry"), wanted));
  std::map<std::string, std::vector<TimedPose>> poses;
  Origins origins;
  for (const auto& trajectory : trajectories)
    reader.on<nav_msgs::Odometry>(trajectory.topic,
                                  [&, topic = trajectory.topic, &into = poses[trajectory.topic]](const auto& odometry) {
                                    const Solution solution = solutionOf(odometry);
                                    if (const auto pose = poseOf(solution)) into.push_back(*pose);
                                    if (topic == kTruth) origins.heights = solution.has_height();
                                  });
  reader.on<sensor_msgs::NavSatFix>("datum", [&](const auto& fix) {
    if (!origins.datum) origins.datum.emplace(geodeticOf(fix));
  });
  reader.on<sensor_msgs::NavSatFix>("truth/fix", [&](const auto& fix) {
    if (origins.fixes.size() < 100 && hasPosition(fix)) origins.fixes[stampOf(fix.header.stamp)] = geodeticOf(fix);
  });
  reader.read();
  auto& truth = poses[kTruth];
  const Eigen::Vector3d shift = origins.shiftOf(truth);
  for (auto& pose : truth) pose.position += shift;
  for (auto& trajectory : trajectories) trajectory.trajectory = imaging::Trajectory(std::move(poses[trajectory.topic]));
  return trajectories;
}

}  // namespace sas_motion
