// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>

namespace sas_motion::ros_side {
namespace {

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

std::vector<MessageSource> findTopics(const std::vector<BagConnection>& connections, std::vector<MessageSource> sources,
                                      const std::string& file) {
  using Need = MessageSource::Need;
  TypeByTopic there = sensorsIn(connections);
  std::set<std::string> named;
  for (auto& source : sources) {
    if (source.need != Need::NamedAlone) continue;
    const auto found = std::find_if(there.begin(), there.end(), [&](const auto& topic) {
      return !source.topic.empty() && bareTopic(topic.first) == bareTopic(source.topic);
    });
    source.topic = found == there.end() ? "" : found->first;
    if (found == there.end()) continue;
    named.insert(found->first);
    if (found->second != source.type)
      throw std::runtime_error(fmt::format("{}: topic {} is a {} but must be a {} (topics.{})", file, found->first,
                                           found->second, source.type, source.name));
  }
  for (const auto& topic : named) there.erase(topic);  // they are no other source's
  std::vector<std::string> missing;
  for (auto& source : sources) {
    if (source.need == Need::NamedAlone) continue;
    const std::string wanted = source.topic;
    source.topic = source.enabled ? find(there, wanted, source.type, file) : "";
    if (source.topic.empty() && source.enabled && source.need == Need::Required)
      missing.push_back(fmt::format("{} ({}, topics.{}): {}", wanted, source.type, source.name, source.use));
  }
  if (missing.empty()) return sources;
  throw std::runtime_error(fmt::format(
      "{}: no topic {}; 'rosbag info' lists what there is. Where there is no such sensor, say enabled: false "
      "in the configuration, if the system can do without",
      file, fmt::join(missing, ", ")));
}

bool isEstimate(const std::string& topic, const std::vector<std::string>& estimators) {
  const std::string bare = bareTopic(topic);
  if (bare == "datum") return true;
  const auto slash = bare.find('/');
  return slash != std::string::npos && isAnswer(bare.substr(slash + 1)) &&
         std::find(estimators.begin(), estimators.end(), bare.substr(0, slash)) != estimators.end();
}

}  // namespace sas_motion::ros_side
