// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/config/source_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

constexpr const char* kNameLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// Keys of the schema that nothing uses yet.
void refuseUnavailable(const YamlSection& yaml) {
  for (const char* key : {"select", "platform", "frame", "mounting", "stamp", "estimate", "prior_sigma"})
    if (yaml.has(key)) yaml.fail(key, "is not available yet; leave it out");
}

void readMeasures(YamlSection& yaml, const SourceKinds& kinds, SourceOptions& source) {
  if (!yaml.has("measures"))
    yaml.fail("measures", fmt::format("is missing; give some of {}", fmt::join(kinds.all, ", ")));
  yaml.texts("measures", source.measures);
  if (source.measures.empty()) yaml.fail("measures", "is empty");
  for (const auto& kind : source.measures)
    if (!contains(kinds.all, kind))
      yaml.fail("measures", fmt::format("has '{}' but may have {}", kind, fmt::join(kinds.all, ", ")));
  const auto place = [&](const std::string& kind) { return std::find(kinds.all.begin(), kinds.all.end(), kind); };
  std::sort(source.measures.begin(), source.measures.end(),
            [&](const auto& a, const auto& b) { return place(a) < place(b); });
}

void readOptions(YamlSection& yaml, bool angle, SensorOptions& options) {
  if (angle) {
    yaml.angle("sigma_deg", options.sigma, {kTiny, 180});
    yaml.angle("floor_deg", options.floor, {0, 180});
    yaml.angle("offset_deg", options.offset, {-360, 360});
  } else {
    yaml.number("sigma", options.sigma, {kTiny, 1e4});
    yaml.number("floor", options.floor, {0, 1e4});
    yaml.number("scale", options.scale, {0.01, 100});
  }
  yaml.boolean("override_message", options.override_message);
  yaml.number("time_offset", options.time_offset, {-3600, 3600});
  yaml.boolean("enabled", options.enabled);
}

void compare(const YamlSection& yaml, const SourceOptions& source, const SourceOptions& other) {
  if (source.name == other.name)
    yaml.fail("name", fmt::format("is '{}', which another source has; give each a name of its own", source.name));
  for (const auto& kind : source.measures)
    if (source.topic == other.topic && contains(other.measures, kind))
      yaml.fail("topic", fmt::format("is {} and measures {}, as {} does; leave one of the two out", source.topic, kind,
                                     other.name));
}

}  // namespace

std::vector<SourceOptions> readSources(YamlSection& yaml, const SourceKinds& kinds,
                                       const std::vector<SensorOptions>& defaults) {
  std::vector<SourceOptions> sources;
  for (auto& item : yaml.list("sources")) {
    SourceOptions source;
    item.text("name", source.name);
    item.text("topic", source.topic);
    if (source.name.empty()) item.fail("name", "is missing; audits and diagnostics call the source by it");
    if (source.name.find_first_not_of(kNameLetters) != std::string::npos)
      item.fail("name", fmt::format("is '{}' but may have letters, digits and _ alone", source.name));
    if (source.topic.empty()) item.fail("topic", fmt::format("is missing; name the topic of {}", source.name));
    refuseUnavailable(item);
    readMeasures(item, kinds, source);
    const auto kind = std::find(kinds.all.begin(), kinds.all.end(), source.measures.front());
    source.options = defaults[static_cast<std::size_t>(kind - kinds.all.begin())];
    readOptions(item, contains(kinds.angles, *kind), source.options);
    item.finish();
    for (const auto& other : sources) compare(item, source, other);
    sources.push_back(source);
  }
  for (const auto& kind : kinds.required)
    if (std::none_of(sources.begin(), sources.end(), [&](const auto& s) { return contains(s.measures, kind); }))
      yaml.fail("sources", fmt::format("has none that measures {}, which this system needs", kind));
  return sources;
}

}  // namespace sas_motion
