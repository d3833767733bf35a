// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace sas_motion {

/// A configuration error: one sentence that names the file, the key, the value and the bound.
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Inclusive bounds of a number.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};
constexpr double kTiny = 1e-12;  ///< the lower bound of what must be positive

/// One mapping of a YAML file. Each read takes a key that may be absent (the value then stays); finish() refuses keys
/// that none of the reads asked for. All errors are ConfigError.
class YamlSection {
 public:
  static YamlSection fromFile(const std::string& file);
  static YamlSection fromText(const std::string& text, const std::string& name);

  bool has(const std::string& key) const;
  bool isList(const std::string& key) const;
  bool isMapping(const std::string& key) const;
  void number(const std::string& key, double& value, Range range);
  /// A key in degrees for a value in radians.
  void angle(const std::string& key_deg, double& value, Range range_deg);
  void integer(const std::string& key, int& value, int lower, int upper);
  void boolean(const std::string& key, bool& value);
  void text(const std::string& key, std::string& value);
  void numbers(const std::string& key, std::vector<double>& values, std::size_t count);
  void texts(const std::string& key, std::vector<std::string>& values);
  /// The mapping under `key`; empty where there is none.
  YamlSection section(const std::string& key);
  /// The mappings of the list under `key`; none where there is none.
  std::vector<YamlSection> list(const std::string& key);
  /// The keys of this mapping, for maps whose keys are names.
  std::vector<std::string> keys() const;
  void finish() const;
  /// Lets a key pass that somebody else reads.
  void ignore(const std::string& key) { asked_.insert(key); }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const;
  const std::string& file() const { return file_; }

 private:
  YamlSection(const YAML::Node& node, std::string file, std::string path);
  YAML::Node take(const std::string& key);
  std::string pathOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  YAML::Node node_;
  std::string file_, path_;
  std::set<std::string> asked_;
};

}  // namespace sas_motion
