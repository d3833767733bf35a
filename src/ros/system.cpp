// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/system.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sas_motion::ros_side {

bool System::knows(const std::string& estimator) const {
  return std::find(estimators.begin(), estimators.end(), estimator) != estimators.end();
}

void System::require(const std::vector<std::string>& names) const {
  if (names.empty()) throw std::runtime_error("no estimator is named; name at least one");
  for (const auto& name : names) {
    if (!knows(name))
      throw std::runtime_error(
          fmt::format("'{}' is no estimator of this system; known are {}", name, fmt::join(estimators, ", ")));
    if (std::count(names.begin(), names.end(), name) > 1)
      throw std::runtime_error(fmt::format("'{}' is there twice; name each once", name));
  }
}

void readTopics(YamlSection& yaml, std::vector<MessageSource>& sources) {
  auto topics = yaml.section("topics");
  for (auto& source : sources) topics.text(source.name, source.topic);
  topics.finish();
}

}  // namespace sas_motion::ros_side
