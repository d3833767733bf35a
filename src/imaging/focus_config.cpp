// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {
namespace {

void readSonarOrFile(YamlSection& yaml, SonarDescription& sonar) {
  if (yaml.has("sonar") && yaml.has("sonar_file")) yaml.fail("sonar_file", "stands beside sonar; name one of them");
  std::string file;
  yaml.text("sonar_file", file);
  readSonar(file.empty() ? yaml.section("sonar")
                         : YamlSection::fromFile((std::filesystem::path(yaml.file()).parent_path() / file).string()),
            sonar);
}

void readAperture(YamlSection yaml, ApertureSettings& aperture) {
  if (yaml.has("start")) {
    aperture.start = 0;
    yaml.number("start", *aperture.start, {0, 1e9});
  }
  yaml.number("duration", aperture.duration, {0, 3600});
  yaml.boolean("speed_locked", aperture.speed_locked);
  yaml.number("longest_gap", aperture.longest_gap, {kTiny, 60});
  yaml.finish();
}

TargetSettings readTarget(YamlSection yaml, const SonarDescription& sonar) {
  TargetSettings target;
  yaml.number("range", target.range, {kTiny, 1e4});
  if (target.range < sonar.near_range || target.range > sonar.far_range)
    yaml.fail("range", fmt::format("is {} but must lie in the sonar's swath, {} to {}", target.range, sonar.near_range,
                                   sonar.far_range));
  if (target.range <= sonar.altitude)
    yaml.fail("range",
              fmt::format("is {} but must be above the sonar's altitude, which is {}", target.range, sonar.altitude));
  yaml.number("along", target.along, {-1e3, 1e3});
  yaml.finish();
  return target;
}

void readTargets(YamlSection& yaml, FocusSettings& settings) {
  std::string side = "starboard";
  yaml.text("side", side);
  if (side != "starboard" && side != "port")
    yaml.fail("side", fmt::format("is '{}' but must be starboard or port", side));
  settings.starboard = side == "starboard";
  std::vector<TargetSettings> targets;
  for (const auto& target : yaml.list("targets")) targets.push_back(readTarget(target, settings.sonar));
  if (yaml.has("targets") && targets.empty()) yaml.fail("targets", "is empty but must hold at least one");
  if (targets.empty()) targets.push_back(readTarget(YamlSection::fromText("{}", yaml.file()), settings.sonar));
  settings.targets = targets;
}

void readBlock(YamlSection yaml, SpeckleSettings& speckle) {
  yaml.number("along", speckle.block_along, {-1e3, 1e3});
  yaml.number("range", speckle.block_range, {-1e3, 1e3});
  readVector<3>(yaml, "size", speckle.block_size);
  if (!(speckle.block_size.minCoeff() > 0)) yaml.fail("size", "must be three numbers above 0");
  yaml.finish();
}

void readSpeckle(YamlSection yaml, SpeckleSettings& speckle) {
  yaml.number("density", speckle.density, {0, 1e6});
  yaml.number("level", speckle.level, {-200, 200});
  speckle.block = yaml.has("block");
  readBlock(yaml.section("block"), speckle);
  if (speckle.block && !(speckle.density > 0))
    yaml.fail("density", "is 0 but must be above 0 where there is a block: its shadow needs speckle to fall on");
  yaml.finish();
}

void readGrid(YamlSection yaml, GridSettings& image) {
  yaml.number("margin", image.margin, {kTiny, 1e3});
  yaml.number("range_step", image.range_step, {0, 10});
  yaml.number("along_step", image.along_step, {0, 10});
  yaml.finish();
}

}  // namespace

FocusSettings readFocus(const std::string& file) {
  auto yaml = YamlSection::fromFile(file);
  FocusSettings settings;
  readSonarOrFile(yaml, settings.sonar);
  readAperture(yaml.section("aperture"), settings.aperture);
  readTargets(yaml, settings);
  readSpeckle(yaml.section("speckle"), settings.speckle);
  readGrid(yaml.section("image"), settings.image);
  yaml.number("noise", settings.noise, {0, 1e6});
  int seed = static_cast<int>(settings.seed);
  yaml.integer("seed", seed, 0, std::numeric_limits<int>::max());
  settings.seed = static_cast<std::uint64_t>(seed);
  yaml.number("memory_limit", settings.memory_limit, {1e6, 1e12});
  yaml.finish();
  return settings;
}

}  // namespace sas_motion::imaging
