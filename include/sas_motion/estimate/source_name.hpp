// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <set>
#include <string>

namespace sas_motion {

/// The same name in memory that lives as long as the program: readings and audits of a source point to it.
inline const char* lastingName(const std::string& name) {
  static std::mutex mutex;
  static std::set<std::string> names;  // its elements do not move
  const std::lock_guard<std::mutex> lock(mutex);
  return names.insert(name).first->c_str();
}

}  // namespace sas_motion
