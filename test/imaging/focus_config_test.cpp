// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <fstream>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "support.hpp"

namespace sas_motion::imaging {
namespace {

/// Reads a text as a file, which may name others beside it.
FocusSettings read(const std::string& text) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "sas_motion_focus_config_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "fine.yaml") << "{element: 0.05, spacing: 0.05, receivers: 16}";
  std::ofstream(folder / "focus.yaml") << text;
  return readFocus((folder / "focus.yaml").string());
}

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  testing::expectRefused([&] { read(text); }, words);
}

TEST(FocusConfig, TheFileWithTheDefaultsIsTheDefaults) {
  const FocusSettings settings = readFocus(std::string(SAS_MOTION_SOURCE_DIR) + "/config/focus.yaml"), defaults;
  EXPECT_EQ(settings.sonar.receivers, defaults.sonar.receivers);
  EXPECT_EQ(settings.aperture.start, defaults.aperture.start);
  EXPECT_EQ(settings.aperture.duration, defaults.aperture.duration);
  EXPECT_EQ(settings.aperture.speed_locked, defaults.aperture.speed_locked);
  EXPECT_EQ(settings.aperture.longest_gap, defaults.aperture.longest_gap);
  ASSERT_EQ(settings.targets.size(), defaults.targets.size());
  EXPECT_EQ(settings.targets[0].range, defaults.targets[0].range);
  EXPECT_EQ(settings.starboard, defaults.starboard);
  EXPECT_EQ(settings.speckle.density, defaults.speckle.density);
  EXPECT_EQ(settings.speckle.level, defaults.speckle.level);
  EXPECT_EQ(settings.speckle.block, defaults.speckle.block);
  EXPECT_EQ(settings.image.margin, defaults.image.margin);
  EXPECT_EQ(settings.memory_limit, defaults.memory_limit);
}

TEST(FocusConfig, ReadsWhatIsGiven) {
  const auto settings = read(
      "{sonar_file: fine.yaml, aperture: {start: 0, duration: 5}, side: port, targets: [{range: 25}, {range: 28, "
      "along: -1}], speckle: {density: 100, block: "
      "{size: [1, 2, 3]}}}");
  EXPECT_EQ(settings.sonar.element, 0.05);
  EXPECT_EQ(settings.aperture.start, 0);
  ASSERT_EQ(settings.targets.size(), 2u);
  EXPECT_EQ(settings.targets[1].along, -1);
  EXPECT_TRUE(settings.speckle.block);
  EXPECT_EQ(settings.speckle.block_size.z(), 3);
  EXPECT_EQ(targetPlaces(settings)[0].y(), std::sqrt(25.0 * 25 - 100)) << "to port, 10 m below";
}

TEST(FocusConfig, RefusesWhatCannotBe) {
  expectRefused("{targets: [{range: 30}, {range: 50}]}", {"targets[1].range is 50", "20 to 45"});
  expectRefused("{sonar: {near_range: 35, far_range: 60}}", {"range is 30", "35 to 60"});
  expectRefused("{sonar: {altitude: 32}}", {"range is 30", "altitude"});
  expectRefused("{targets: []}", {"targets", "at least one"});
  expectRefused("{side: left}", {"side is 'left'", "starboard or port"});
  expectRefused("{sonar: {}, sonar_file: fine.yaml}", {"sonar_file", "one of them"});
  expectRefused("{sonar_file: none.yaml}", {"none.yaml", "check the path"});
  expectRefused("{speckle: {block: {}}}", {"speckle.density", "shadow"});
  expectRefused("{speckle: {density: 9, block: {size: [1, 0, 1]}}}", {"speckle.block.size"});
  expectRefused("{apertures: {}}", {"apertures is no known key"});
}

TEST(FocusGrid, HoldsAllTargetsAndTheirSideLobes) {
  FocusSettings settings;
  settings.targets = {{25, 0}, {28, -2}};
  const ImageGrid grid = focusGrid(settings, 4.5, 64);
  for (const auto& place : targetPlaces(settings)) {
    const double row = (place - grid.origin).dot(grid.range_axis) / grid.range_step,
                 column = (place - grid.origin).dot(grid.along_axis) / grid.along_step;
    EXPECT_GT(std::min(row, column), 64);
    EXPECT_LT(row, grid.rows - 64);
    EXPECT_LT(column, grid.columns - 64);
  }
  EXPECT_NEAR(searchRadius(settings, grid, 64), (std::sqrt(28.0 * 28 - 100) - std::sqrt(25.0 * 25 - 100)) / 2, 1e-9)
      << "half way to the other";
  EXPECT_GE(focusGrid(settings, 1000, 64).along_step, 0.4 * settings.sonar.element / 4)
      << "no finer than the beam lets see";
  settings.image.range_step = 1e-9;
  EXPECT_THROW(focusGrid(settings, 4.5, 64), std::invalid_argument);
  settings.image = {};
  settings.image.margin = 0.5;
  EXPECT_THROW(focusGrid(settings, 4.5, 64), std::invalid_argument);
}

TEST(FocusScene, ABlockHidesWhatIsBehindItAndNotTheTarget) {
  FocusSettings settings;
  settings.speckle.density = 50;
  settings.speckle.block = true;
  settings.speckle.level = -20;
  const ImageGrid grid = focusGrid(settings, 4.5, 64);
  const Scene scene = focusScene(settings, grid);
  ASSERT_EQ(scene.blocks.size(), 1u);
  const Eigen::Vector3d sonar(0, 0, settings.sonar.altitude), target = targetPlaces(settings)[0];
  EXPECT_TRUE(scene.scatterers.back().position.isApprox(target));
  EXPECT_FALSE(scene.blocks[0].hides(sonar, target));
  EXPECT_TRUE(scene.blocks[0].hides(sonar, target + Eigen::Vector3d(0, -1.8, 0)));
  double power = 0;
  for (const auto& scatterer : scene.scatterers) power += std::norm(scatterer.amplitude);
  const double bottom = static_cast<double>(grid.pixels()) * grid.range_step * grid.along_step,
               faces = 0.5 + 2 * 0.5 + 2 * 0.25;
  EXPECT_NEAR(power - 1, 0.01 * (bottom + 10 * faces), 0.1)
      << "-20 dB a square metre, the block's faces 10 times as much";
}

}  // namespace
}  // namespace sas_motion::imaging
