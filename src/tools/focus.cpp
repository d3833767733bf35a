// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// focus IN.bag -o OUT_DIR: what a synthetic aperture sonar would see with each trajectory in a bag.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cmath>
#include <filesystem>

#include "focus_window.hpp"
#include "main_guard.hpp"
#include "progress.hpp"
#include "sas_motion/config/focus_config.hpp"
#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/image_file.hpp"
#include "sas_motion/imaging/phase_gradient.hpp"
#include "sas_motion/imaging/range_compression.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;

constexpr int kHalfChip = 64;  // pixels: 25 resolutions, so that ten null widths of a tapered aperture fit

struct Options {
  std::string bag, out, config;
  std::vector<std::string> trajectories;
  int jobs = 1;
  bool autofocus = false, figures = true;
};

/// Echoes from the true track, compressed.
EchoLines listen(const FocusSettings& settings, const std::vector<PingPose>& truth, const ImageGrid& grid, int threads) {
  EchoOptions echo;
  echo.noise = settings.noise;
  echo.seed = settings.seed;
  echo.threads = threads;
  CompressionOptions compression;
  compression.filter = RangeFilter::Equalized;
  compression.threads = threads;
  return compressRange(simulateEchoes(settings.sonar, echoPaths(settings.sonar, truth), focusScene(settings, grid), echo), settings.sonar, compression);
}

void requireMemory(const Options& options, const FocusSettings& settings, const ImageGrid& grid, std::size_t lines) {
  const double needed = memoryNeeded(settings, grid, lines);
  if (needed > settings.memory_limit)
    throw std::runtime_error(
        fmt::format("{}: {} lines, {} x {} pixels and the scene need {:.0f} MB but may have {:.0f} MB; set a shorter aperture.duration, a smaller "
                    "image.margin or speckle.density, or raise memory_limit",
                    options.bag, lines, grid.rows, grid.columns, needed / 1e6, settings.memory_limit / 1e6));
}

/// Focuses, measures and writes the image of one trajectory after another.
class Bench {
 public:
  Bench(const Options& options, const FocusSettings& settings, const FocusPings& pings)
      : options_(options),
        settings_(settings),
        pings_(pings),
        grid_(focusGrid(settings, pings.window.speed * pings.window.duration, kHalfChip)),
        places_(targetPlaces(settings)) {
    requireMemory(options, settings, grid_, pings.window.pings * static_cast<std::size_t>(settings.sonar.receivers));
    lines_ = listen(settings, pings.poses.front(), grid_, options.jobs);
  }

  /// `which` is the trajectory's place; truth is the first, and its image's peaks are the reference of the others.
  FocusedTrajectory focus(const RecordedTrajectory& trajectory, std::size_t which) {
    const auto& truth = pings_.poses.front();
    FocusedTrajectory result{
        trajectory.name, trajectory.topic, apertureTrajectoryError(settings_.sonar, pings_.times, truth, pings_.poses[which], places_.front()), {}, {}, {}};
    result.shift = imageShift(result.error, truth, pings_.window.speed, places_.front());
    lines_.paths = echoPaths(settings_.sonar, pings_.poses[which]);
    BackprojectionOptions backprojection;
    backprojection.threads = options_.jobs;
    backprojection.memory_limit = settings_.memory_limit;
    ImageGrid grid = grid_;
    grid.origin += result.shift;
    const Image image = backproject(lines_, grid, backprojection);
    result.image = measured(image, which, trajectory.name);
    if (options_.autofocus) result.autofocused = measured(phaseGradientAutofocus(image, {}).image, which, trajectory.name + "_autofocus");
    return result;
  }

 private:
  /// Measures around where the trajectory must see the targets, but the peak's error from where they are; and writes the image.
  FocusImage measured(const Image& image, std::size_t which, const std::string& stem) {
    FocusImage result;
    result.stem = stem;
    ChipOptions chip;
    chip.half_size = kHalfChip;
    chip.search_radius = searchRadius(settings_, grid_, kHalfChip);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto error = apertureTrajectoryError(settings_.sonar, pings_.times, pings_.poses.front(), pings_.poses[which], places_[i]);
      auto target = measurePointTarget(image, places_[i] + imageShift(error, pings_.poses.front(), pings_.window.speed, places_[i]), chip);
      if (i == reference_powers_.size()) reference_powers_.push_back(std::max(target.range.peak_power, target.along.peak_power));
      target.peak_loss += 10 * std::log10(reference_powers_[i]);
      if (target.complete) target.peak_error = (target.peak_position - places_[i]).head<2>().norm();
      result.targets.push_back(target);
    }
    result.whole_image_islr = wholeImageIslr(image, result.targets.front());
    result.entropy = imageEntropy(image);
    makeFolder(options_.out);
    writeImage(options_.out + "/" + stem, image);
    return result;
  }

  const Options& options_;
  const FocusSettings& settings_;
  const FocusPings& pings_;
  ImageGrid grid_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<double> reference_powers_;  // of the peaks in the first image measured, truth's
  EchoLines lines_;
};

/// By the script beside this tool, which reads what stands in the folder.
void drawFigures(const std::string& folder) {
  const std::string script = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plot_focus.py").string();
  std::string first = script, second = folder;
  char* arguments[] = {first.data(), second.data(), nullptr};
  pid_t child = 0;
  int status = 1;
  if (posix_spawn(&child, script.c_str(), nullptr, nullptr, arguments, environ) != 0 || waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error(
        fmt::format("{}: the figures could not be drawn by {}; images and measures are there, --no-figures leaves figures out", folder, script));
}

void run(const Options& options) {
  FocusResult result;
  result.bag = options.bag;
  if (!options.config.empty()) result.settings = readFocus(options.config);
  const auto trajectories = readTrajectories(options.bag, options.trajectories);
  const FocusPings pings = choosePings(options.bag, trajectories, result.settings);
  result.window = pings.window;
  {
    Progress progress("focus", static_cast<double>(trajectories.size() + 1), 0);
    Bench bench(options, result.settings, pings);
    progress.advance(1);
    for (std::size_t i = 0; i < trajectories.size(); ++i) {
      result.trajectories.push_back(bench.focus(trajectories[i], i));
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
      "What a synthetic aperture sonar would see with each trajectory in a bag: echoes of a scene are simulated on truth/odometry and focused along truth and "
      "along "
      "each NAME/odometry. Writes NAME.npy, NAME.json and NAME.png, the measures of all in focus.json, and the images beside each other in focus.png.",
      "focus");
  app.add_option("BAG", options.bag, "bag with truth and estimates")->required();
  app.add_option("-o,--output", options.out, "folder for the results")->required();
  app.add_option("--trajectory", options.trajectories, "topics or names to focus along beside truth (default: all named NAME/odometry)");
  app.add_option("--config", options.config, "sonar, aperture, scene and image (YAML; default: as in config/focus.yaml)");
  app.add_option("-j,--jobs", options.jobs, "threads (default 1)")->check(CLI::Range(1, 1024));
  app.add_flag("--autofocus", options.autofocus, "also the phase-gradient-autofocused image of each trajectory");
  app.add_flag("!--no-figures", options.figures, "write no PNG");
  return runTool(app, argc, argv, [&] { run(options); });
}
