// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <set>

#include "bag/bag_reader.hpp"
#include "bag/topics.hpp"

namespace sas_motion::ros_side {

/// The bare names of all topics of a type.
inline std::set<std::string> topicsOf(const BagReader& bag, const std::string& type) {
  std::set<std::string> topics;
  for (const auto& connection : bag.connections())
    if (connection.type == type) topics.insert(bareTopic(connection.topic));
  return topics;
}

/// The first part of NAME/leaf; empty where a topic has another leaf.
inline std::string nameBefore(const std::string& leaf, const std::string& topic) {
  const std::string end = "/" + leaf;
  const bool has = topic.size() > end.size() && topic.compare(topic.size() - end.size(), end.size(), end) == 0;
  return has ? topic.substr(0, topic.size() - end.size()) : "";
}

/// The topic of an estimator's solutions: the settled ones where the bag has them, else the present ones.
inline std::string solutionTopic(const std::set<std::string>& odometry_topics, const std::string& name) {
  return name + (odometry_topics.count(name + "/settled") ? "/settled" : "/odometry");
}

/// Hands the messages of a bag to functions, each of one topic and type.
class TopicReader {
 public:
  explicit TopicReader(BagReader& bag) : bag_(bag) {}

  template <class Message, class Use>
  void on(const std::string& bare_topic, Use use) {
    uses_[bare_topic] = [this, use, message = Message()](const BagMessage& from) mutable {
      if (bag_.get(from, message)) use(message);
    };
  }
  void read() {
    while (const BagMessage* message = bag_.next())
      if (const auto use = uses_.find(bareTopic(message->connection->topic)); use != uses_.end()) use->second(*message);
  }

 private:
  BagReader& bag_;
  std::map<std::string, std::function<void(const BagMessage&)>> uses_;
};

}  // namespace sas_motion::ros_side
