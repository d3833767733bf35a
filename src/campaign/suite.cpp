// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/suite.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "sas_motion/io/fingerprint.hpp"

namespace sas_motion {
namespace {

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The suite without the number of runs, and the files that it names.
std::string whatRunsDependOn(const std::string& file) {
  YAML::Node root = YAML::LoadFile(file);
  root.remove("runs");
  std::string all = YAML::Dump(root);
  for (const auto& campaign : root["campaigns"])
    for (const char* key : {"scenario", "config"})
      if (campaign[key] && campaign[key].IsScalar())
        all += contents(std::filesystem::path(file).parent_path() / campaign[key].as<std::string>());
  return all;
}

std::vector<std::string> namesOf(const CampaignReaders& readers) {
  std::vector<std::string> names;
  for (const auto& [name, reader] : readers) names.push_back(name);
  return names;
}

}  // namespace

Suite Suite::fromFile(const std::string& file, const CampaignReaders& readers) {
  auto yaml = YamlSection::fromFile(file);
  const std::string folder = std::filesystem::path(file).parent_path();
  Suite suite;
  suite.name = std::filesystem::path(file).stem();
  yaml.text("name", suite.name);
  yaml.integer("runs", suite.runs, 1, 1'000'000);
  int seed = 1;
  yaml.integer("first_seed", seed, 0, 2'000'000'000);
  suite.first_seed = static_cast<std::uint64_t>(seed);
  std::set<std::string> names;
  for (auto& item : yaml.list("campaigns")) {
    std::string name, kind = "towfish";
    item.text("name", name);
    item.text("system", kind);
    if (name.empty()) item.fail("name", "is missing; give each campaign one");
    if (!names.insert(name).second) item.fail("name", fmt::format("is '{}' but another campaign has it", name));
    const auto reader = readers.find(kind);
    if (reader == readers.end())
      item.fail("system", fmt::format("is '{}' but must be one of {}", kind, fmt::join(namesOf(readers), ", ")));
    suite.campaigns.push_back(reader->second(item, folder));
    suite.campaigns.back()->title = name;
    suite.campaigns.back()->kind = kind;
    item.finish();
  }
  if (suite.campaigns.empty()) yaml.fail("campaigns", "is missing; list at least one");
  yaml.finish();
  suite.hash = Fingerprint::ofText(whatRunsDependOn(file));
  return suite;
}

std::size_t Suite::firstTask(std::size_t campaign) const {
  std::size_t laws = 0;
  for (std::size_t i = 0; i < campaign; ++i) laws += campaigns[i]->laws.size();
  return laws * static_cast<std::size_t>(runs);
}

std::size_t Suite::tasks() const { return firstTask(campaigns.size()); }

Suite::Task Suite::task(std::size_t index) const {
  std::size_t campaign = 0;
  while (index >= firstTask(campaign + 1)) ++campaign;
  const std::size_t within = index - firstTask(campaign), per_law = static_cast<std::size_t>(runs);
  return {campaigns[campaign].get(), within / per_law, first_seed + within % per_law};
}

}  // namespace sas_motion
