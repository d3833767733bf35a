// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

namespace sas_motion::ros_side {
namespace {

constexpr const char* kTwist = "geometry_msgs/TwistWithCovarianceStamped";

using TypeByTopic = std::map<std::string, std::string>;

/// Whether an estimator NAME writes NAME/leaf.
bool isAnswer(const std::string& leaf) {
  constexpr std::array<const char*, 6> leaves{"odometry", "fix", "current", "settled", "settled_current", "update"};
  return std::find(leaves.begin(), leaves.end(), leaf) != leaves.end();
}

bool reserved(const std::string& topic) {
  const std::string bare = bareTopic(topic);
  return bare.rfind("truth/", 0) == 0 || bare == "datum";
}

std::string find(const TypeByTopic& types, const std::string& wanted, const std::string& type,
                 const std::string& file) {
  std::vector<std::string> candidates;
  for (const auto& [topic, topic_type] : types) {
    if (topic_type != type || reserved(topic)) continue;
    if (bareTopic(topic) == bareTopic(wanted)) return topic;
    candidates.push_back(topic);
  }
  if (candidates.size() > 1)
    throw std::runtime_error(
        fmt::format("{}: no topic {} but {} of its type {}: {}; name one under topics: in the configuration", file,
                    wanted, candidates.size(), type, fmt::join(candidates, ", ")));
  return candidates.empty() ? "" : candidates.front();
}

/// Those that no estimator wrote in an earlier run.
TypeByTopic sensorsIn(const std::vector<BagConnection>& connections) {
  TypeByTopic types, sensors;
  for (const auto& connection : connections) types[connection.topic] = connection.type;
  for (const auto& [topic, type] : types) {
    const auto slash = topic.rfind('/');
    const bool estimate = slash != std::string::npos && isAnswer(topic.substr(slash + 1)) &&
                          types.count(topic.substr(0, slash) + "/update") > 0;
    if (!estimate) sensors[topic] = type;
  }
  return sensors;
}

}  // namespace

SensorTopics findTopics(const std::vector<BagConnection>& connections, const Settings& settings,
                        const std::string& file) {
  const TypeByTopic sensors = sensorsIn(connections);
  SensorTopics topics;
  topics.fix = find(sensors, settings.fix_topic, "sensor_msgs/NavSatFix", file);
  topics.imu = find(sensors, settings.imu_topic, "sensor_msgs/Imu", file);
  topics.twist = find(sensors, settings.twist_topic, "geometry_msgs/TwistWithCovarianceStamped", file);
  if (topics.fix.empty() && topics.imu.empty() && topics.twist.empty())
    throw std::runtime_error(fmt::format(
        "{}: no known topic; {}, {} or {} (or topics of their types) are needed, 'rosbag info' lists what there is",
        file, settings.fix_topic, settings.imu_topic, settings.twist_topic));
  if (topics.fix.empty())
    throw std::runtime_error(fmt::format("{}: no topic {} or any other sensor_msgs/NavSatFix; positions are needed",
                                         file, settings.fix_topic));
  if (topics.imu.empty())
    throw std::runtime_error(
        fmt::format("{}: no topic {} or any other sensor_msgs/Imu; headings are needed", file, settings.imu_topic));
  return topics;
}

InsTopics findTopics(const std::vector<BagConnection>& connections, const InsSettings& settings,
                     const std::string& file) {
  TypeByTopic sensors = sensorsIn(connections);
  InsTopics topics;
  for (const auto& [topic, type] : sensors) {
    if (settings.velocity_topic.empty() || bareTopic(topic) != bareTopic(settings.velocity_topic)) continue;
    if (type != kTwist)
      throw std::runtime_error(
          fmt::format("{}: topic {} is a {} but must be a {} (topics.velocity)", file, topic, type, kTwist));
    topics.velocity = topic;
  }
  sensors.erase(topics.velocity);  // it is not the DVL's
  std::vector<std::string> missing;
  const auto take = [&](std::string& topic, const std::string& wanted, const char* type, const char* key,
                        bool enabled) {
    topic = enabled ? find(sensors, wanted, type, file) : "";
    if (topic.empty() && enabled) missing.push_back(fmt::format("{} ({}, topics.{})", wanted, type, key));
  };
  const auto enabled = [&](ins::Sensor sensor) { return settings.estimation.of(sensor).enabled; };
  take(topics.imu, settings.imu_topic, "sensor_msgs/Imu", "imu", true);
  take(topics.fix, settings.fix_topic, "sensor_msgs/NavSatFix", "fix", enabled(ins::Sensor::Gps));
  take(topics.twist, settings.twist_topic, kTwist, "twist", enabled(ins::Sensor::Dvl));
  take(topics.depth, settings.depth_topic, "geometry_msgs/PoseWithCovarianceStamped", "depth",
       enabled(ins::Sensor::Depth));
  if (missing.empty()) return topics;
  throw std::runtime_error(
      fmt::format("{}: no topic {}; 'rosbag info' lists what there is. Where there is no such sensor, say enabled: "
                  "false under {} in the configuration",
                  file, fmt::join(missing, ", "),
                  settings.estimation.session.alignment.fixes_aid ? "gps, dvl or depth"
                                                                  : "dvl or depth; a fix has to start the INS"));
}

bool isEstimate(const std::string& topic, const std::vector<std::string>& estimators) {
  const std::string bare = bareTopic(topic);
  if (bare == "datum") return true;
  const auto slash = bare.find('/');
  return slash != std::string::npos && isAnswer(bare.substr(slash + 1)) &&
         std::find(estimators.begin(), estimators.end(), bare.substr(0, slash)) != estimators.end();
}

}  // namespace sas_motion::ros_side
