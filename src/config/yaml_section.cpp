// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/config/yaml_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

YAML::Node parsed(const std::string& name, const std::function<YAML::Node()>& load) {
  try {
    return load();
  } catch (const std::exception& error) {  // of YAML, or of the stream where the file is a folder
    throw ConfigError(fmt::format("{}: not readable as YAML: {}", name, error.what()));
  }
}

}  // namespace

YamlSection::YamlSection(const YAML::Node& node, std::string file, std::string path)
    : node_(node), file_(std::move(file)), path_(std::move(path)) {
  if (node_.IsDefined() && !node_.IsNull() && !node_.IsMap())
    throw ConfigError(
        fmt::format("{}: {} must be a mapping of keys to values", file_, path_.empty() ? "the file" : path_));
}

YamlSection YamlSection::fromFile(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw ConfigError(fmt::format("{}: cannot be read; check the path", file));
  // Read here and not by yaml-cpp, which leaks its buffer where reading fails.
  const auto load = [&] { return YAML::Load(std::string(std::istreambuf_iterator<char>(stream), {})); };
  return {parsed(file, load), file, ""};
}

YamlSection YamlSection::fromText(const std::string& text, const std::string& name) {
  return {parsed(name, [&] { return YAML::Load(text); }), name, ""};
}

void YamlSection::fail(const std::string& key, const std::string& what) const {
  throw ConfigError(fmt::format("{}: {} {}", file_, pathOf(key), what));
}

bool YamlSection::has(const std::string& key) const { return node_.IsMap() && node_[key].IsDefined(); }

bool YamlSection::isList(const std::string& key) const { return has(key) && node_[key].IsSequence(); }
bool YamlSection::isMapping(const std::string& key) const { return has(key) && node_[key].IsMap(); }

YAML::Node YamlSection::take(const std::string& key) {
  asked_.insert(key);
  return has(key) ? node_[key] : YAML::Node(YAML::NodeType::Undefined);
}

namespace {
template <class T>
bool decode(const YAML::Node& node, T& value) {
  return node.IsScalar() && YAML::convert<T>::decode(node, value);
}
}  // namespace

void YamlSection::number(const std::string& key, double& value, Range range) {
  const YAML::Node node = take(key);
  if (!node.IsDefined()) return;
  if (!decode(node, value)) fail(key, "must be a number");
  if (!(value >= range.lower && value <= range.upper)) {
    const std::string lower = range.lower == kTiny ? "above 0" : fmt::format("at least {}", range.lower);
    fail(key, fmt::format("is {} but must be {}{}", value, lower,
                          std::isfinite(range.upper) ? fmt::format(" and at most {}", range.upper) : ""));
  }
}

void YamlSection::angle(const std::string& key_deg, double& value, Range range_deg) {
  double degrees = value / kRadPerDeg;
  number(key_deg, degrees, range_deg);
  value = degrees * kRadPerDeg;
}

void YamlSection::integer(const std::string& key, int& value, int lower, int upper) {
  const YAML::Node node = take(key);
  if (!node.IsDefined()) return;
  if (!decode(node, value)) fail(key, "must be a whole number");
  if (value < lower || value > upper)
    fail(key, fmt::format("is {} but must lie between {} and {}", value, lower, upper));
}

void YamlSection::boolean(const std::string& key, bool& value) {
  const YAML::Node node = take(key);
  if (node.IsDefined() && !decode(node, value)) fail(key, "must be true or false");
}

void YamlSection::text(const std::string& key, std::string& value) {
  const YAML::Node node = take(key);
  if (node.IsDefined() && !decode(node, value)) fail(key, "must be a text");
}

void YamlSection::numbers(const std::string& key, std::vector<double>& values, std::size_t count) {
  const YAML::Node node = take(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence() || node.size() != count) fail(key, fmt::format("must be a list of {} numbers", count));
  values.clear();
  for (const auto& item : node) {
    double value = 0;
    if (!decode(item, value) || !std::isfinite(value)) fail(key, fmt::format("must be a list of {} numbers", count));
    values.push_back(value);
  }
}

void YamlSection::texts(const std::string& key, std::vector<std::string>& values) {
  const YAML::Node node = take(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) fail(key, "must be a list");
  values.clear();
  for (const auto& item : node) {
    if (!item.IsScalar()) fail(key, "must be a list of texts");
    values.push_back(item.Scalar());
  }
}

YamlSection YamlSection::section(const std::string& key) { return {take(key), file_, pathOf(key)}; }

std::vector<YamlSection> YamlSection::list(const std::string& key) {
  const YAML::Node node = take(key);
  std::vector<YamlSection> sections;
  if (!node.IsDefined()) return sections;
  if (!node.IsSequence()) fail(key, "must be a list");
  for (std::size_t i = 0; i < node.size(); ++i)
    sections.push_back(YamlSection(node[i], file_, fmt::format("{}[{}]", pathOf(key), i)));
  return sections;
}

std::vector<std::string> YamlSection::keys() const {
  std::vector<std::string> names;
  if (node_.IsMap())
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar())
        throw ConfigError(fmt::format("{}: {} has a key that is no word", file_, path_.empty() ? "the file" : path_));
      names.push_back(entry.first.Scalar());
    }
  return names;
}

void YamlSection::finish() const {
  for (const auto& key : keys())
    if (!asked_.count(key)) fail(key, fmt::format("is no known key; known here: {}", fmt::join(asked_, ", ")));
}

}  // namespace sas_motion
