// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/bag/topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace sas_motion::ros_side {
namespace {

using TypeByTopic = std::map<std::string, std::string>;

bool reserved(const std::string& topic) {
  const std::string bare = bareTopic(topic);
  return bare.rfind("truth/", 0) == 0 || bare == "datum";
}

std::string find(const TypeByTopic& types, const std::string& wanted, const std::string& type, const std::string& file) {
  std::vector<std::string> candidates;
  for (const auto& [topic, topic_type] : types) {
    if (topic_type != type || reserved(topic)) continue;
    if (bareTopic(topic) == bareTopic(wanted)) return topic;
    candidates.push_back(topic);
  }
  if (candidates.size() > 1)
    throw std::runtime_error(fmt::format("{}: no topic {} but {} of its type {}: {}; name one under topics: in the configuration", file, wanted,
                                         candidates.size(), type, fmt::join(candidates, ", ")));
  return candidates.empty() ? "" : candidates.front();
}

}  // namespace

SensorTopics findTopics(const std::vector<BagConnection>& connections, const Settings& settings, const std::string& file) {
  TypeByTopic types;
  for (const auto& connection : connections) types[connection.topic] = connection.type;
  // What an earlier run has put there is no sensor.
  TypeByTopic sensors;
  for (const auto& [topic, type] : types) {
    const auto slash = topic.rfind('/');
    const bool estimate = slash != std::string::npos && types.count(topic.substr(0, slash) + "/update") > 0;
    if (!estimate) sensors[topic] = type;
  }
  SensorTopics topics;
  topics.fix = find(sensors, settings.fix_topic, "sensor_msgs/NavSatFix", file);
  topics.imu = find(sensors, settings.imu_topic, "sensor_msgs/Imu", file);
  topics.twist = find(sensors, settings.twist_topic, "geometry_msgs/TwistWithCovarianceStamped", file);
  if (topics.fix.empty() && topics.imu.empty() && topics.twist.empty())
    throw std::runtime_error(fmt::format("{}: no known topic; {}, {} or {} (or topics of their types) are needed, 'rosbag info' lists what there is", file,
                                         settings.fix_topic, settings.imu_topic, settings.twist_topic));
  if (topics.fix.empty())
    throw std::runtime_error(fmt::format("{}: no topic {} or any other sensor_msgs/NavSatFix; positions are needed", file, settings.fix_topic));
  if (topics.imu.empty()) throw std::runtime_error(fmt::format("{}: no topic {} or any other sensor_msgs/Imu; headings are needed", file, settings.imu_topic));
  for (const auto& [topic, type] : types)
    if (type == "tf2_msgs/TFMessage") topics.transforms.insert(topic);
  return topics;
}

bool isEstimate(const std::string& topic, const std::vector<std::string>& estimators) {
  const std::string bare = bareTopic(topic);
  if (bare == "datum") return true;
  const auto slash = bare.find('/');
  return slash != std::string::npos && std::find(estimators.begin(), estimators.end(), bare.substr(0, slash)) != estimators.end();
}

}  // namespace sas_motion::ros_side
