// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

namespace sas_motion {

/// Replaces the old names of estimators by their present ones. Returns a sentence about each for the user.
inline std::vector<std::string> replaceOldNames(std::vector<std::string>& names,
                                                const std::function<std::string(const std::string&)>& current_name) {
  std::vector<std::string> sentences;
  for (auto& name : names) {
    const std::string now = current_name(name);
    if (now != name) sentences.push_back(fmt::format("'{}' is now called {}", name, now));
    name = now;
  }
  return sentences;
}

}  // namespace sas_motion
