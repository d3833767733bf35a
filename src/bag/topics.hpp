// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bag/chunk_file.hpp"
#include "ros/message_source.hpp"

namespace sas_motion::ros_side {

/// A topic's name without its leading slash: bags recorded live have one, bags written by tools often not.
inline std::string bareTopic(const std::string& topic) {
  return !topic.empty() && topic[0] == '/' ? topic.substr(1) : topic;
}

/// The same sources with their topics as the bag spells them; empty where it has none. Each is found by its configured
/// topic or, where the bag has no such topic, by its type when only one topic has it. A source that is not enabled is
/// not looked for. Throws std::runtime_error where the choice is ambiguous, and where required sources have no topic:
/// it names all of those.
std::vector<MessageSource> findTopics(const std::vector<BagConnection>& connections, std::vector<MessageSource> sources,
                                      const std::string& file);

/// Whether a topic is what one of these estimators, or the datum, wrote in an earlier run.
bool isEstimate(const std::string& topic, const std::vector<std::string>& estimators);

}  // namespace sas_motion::ros_side
