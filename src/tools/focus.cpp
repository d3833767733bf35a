// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// focus IN.bag -o OUT_DIR: what a synthetic aperture sonar would see with each trajectory in a bag.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>

#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "tools/focus_steps.hpp"
#include "tools/main_guard.hpp"
#include "tools/progress.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;

struct Options {
  std::string bag, out, config;
  std::vector<std::string> trajectories;
  int jobs = 1;
  bool autofocus = false, figures = true;
};

/// Draws the figures of a folder by the script beside this tool.
void drawFigures(const std::string& folder) {
  const std::string script = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plot_focus.py").string();
  std::string first = script, second = folder;
  char* arguments[] = {first.data(), second.data(), nullptr};
  pid_t child = 0;
  int status = 1;
  if (posix_spawn(&child, script.c_str(), nullptr, nullptr, arguments, environ) != 0 ||
      waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error(fmt::format(
        "{}: the figures could not be drawn by {}; images and measures are there, --no-figures leaves figures out",
        folder, script));
}

void run(const Options& options) {
  FocusResult result;
  result.bag = options.bag;
  if (!options.config.empty()) result.settings = readFocus(options.config);
  const auto trajectories = readTrajectories(options.bag, options.trajectories);
  const FocusPings pings = choosePings(options.bag, trajectories, result.settings);
  result.window = pings.window;
  result.places = targetPlaces(result.settings);
  {
    Progress progress("focus", static_cast<double>(trajectories.size() + 1), 0);
    FocusBench bench(result.settings, pings.times, pings.poses.front(), options.jobs);
    progress.advance(1);
    for (std::size_t i = 0; i < trajectories.size(); ++i) {
      result.trajectories.push_back(
          focusAlong(bench, pings.poses[i], options.out, trajectories[i].name, options.autofocus));
      result.trajectories.back().topic = trajectories[i].topic;
      progress.advance(1);
    }
  }
  writeFile(options.out + "/focus.json", focusDocument(result));
  fmt::print("{}", focusTable(result));
  if (options.figures) drawFigures(options.out);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "What a synthetic aperture sonar would see with each trajectory in a bag: echoes of a scene are simulated on "
      "truth/odometry and focused along truth and along each NAME/odometry. Writes NAME.npy, NAME.json and NAME.png, "
      "the measures of all in focus.json, and the images "
      "beside each other in focus.png.",
      "focus");
  app.add_option("BAG", options.bag, "bag with truth and estimates")->required();
  app.add_option("-o,--output", options.out, "folder for the results")->required();
  app.add_option("--trajectory", options.trajectories,
                 "topics or names to focus along beside truth (default: all named NAME/odometry)");
  app.add_option("--config", options.config,
                 "sonar, aperture, scene and image (YAML; default: as in config/focus.yaml)");
  app.add_option("-j,--jobs", options.jobs, "threads (default 1)")->check(CLI::Range(1, 1024));
  app.add_flag("--autofocus", options.autofocus, "also the phase-gradient-autofocused image of each trajectory");
  app.add_flag("!--no-figures", options.figures, "write no PNG");
  return runTool(app, argc, argv, [&] { run(options); });
}
