// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "focus_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/image_file.hpp"
#include "sas_motion/imaging/phase_gradient.hpp"
#include "sas_motion/imaging/range_compression.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion {

using namespace imaging;

namespace {

constexpr int kHalfChip = 64;  // pixels: 25 resolutions, so that ten null widths of a tapered aperture fit

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

void requireMemory(const FocusOptions& options, const FocusSettings& settings, const ImageGrid& grid, std::size_t lines) {
  const double needed = memoryNeeded(settings, grid, lines);
  if (needed > settings.memory_limit)
    throw std::runtime_error(
        fmt::format("{}: {} lines, {} x {} pixels and the scene need {:.0f} MB but may have {:.0f} MB; set a shorter aperture.duration, a smaller "
                    "image.margin or speckle.density, or raise memory_limit",
                    options.bag, lines, grid.rows, grid.columns, needed / 1e6, settings.memory_limit / 1e6));
}

}  // namespace

FocusBench::FocusBench(const FocusOptions& options, const FocusSettings& settings, const FocusPings& pings)
    : options_(options),
      settings_(settings),
      pings_(pings),
      grid_(focusGrid(settings, pings.window.speed * pings.window.duration, kHalfChip)),
      places_(targetPlaces(settings)) {
  requireMemory(options, settings, grid_, pings.window.pings * static_cast<std::size_t>(settings.sonar.receivers));
  lines_ = listen(settings, pings.poses.front(), grid_, options.jobs);
}

FocusedTrajectory FocusBench::focus(const RecordedTrajectory& trajectory, std::size_t which) {
  const auto& poses = pings_.poses[which];
  FocusedTrajectory result;
  result.name = trajectory.name;
  result.topic = trajectory.topic;
  result.error = apertureTrajectoryError(settings_.sonar, pings_.times, pings_.poses.front(), poses, places_.front());
  lines_.paths = echoPaths(settings_.sonar, poses);
  BackprojectionOptions backprojection;
  backprojection.threads = options_.jobs;
  backprojection.memory_limit = settings_.memory_limit;
  ImageGrid grid = grid_;
  grid.origin += result.error.image_shift;
  const Image image = backproject(lines_, grid, backprojection);
  result.image = measured(image, which, trajectory.name);
  if (options_.autofocus) result.autofocused = measured(phaseGradientAutofocus(image, {}).image, which, trajectory.name + "_autofocus");
  return result;
}

/// Also writes the image.
FocusImage FocusBench::measured(const Image& image, std::size_t which, const std::string& stem) {
  FocusImage result;
  result.stem = stem;
  for (std::size_t target = 0; target < places_.size(); ++target) result.targets.push_back(measuredTarget(image, which, target));
  result.whole_image_islr = wholeImageIslr(image, result.targets.front());
  result.entropy = imageEntropy(image);
  makeFolder(options_.out);
  writeImage(options_.out + "/" + stem, image);
  return result;
}

/// Looks for the peak where mean and trend of the trajectory's error must have moved it, but measures its error from where the target is.
PointTargetMeasures FocusBench::measuredTarget(const Image& image, std::size_t which, std::size_t target) {
  const Eigen::Vector3d& place = places_[target];
  const auto error = apertureTrajectoryError(settings_.sonar, pings_.times, pings_.poses.front(), pings_.poses[which], place);
  ChipOptions chip;
  chip.half_size = kHalfChip;
  chip.search_radius = searchRadius(settings_, grid_, kHalfChip);
  auto measures = measurePointTarget(image, place + error.image_shift, chip);
  if (target == reference_powers_.size()) reference_powers_.push_back(std::max(measures.range.peak_power, measures.along.peak_power));
  measures.peak_loss += 10 * std::log10(reference_powers_[target]);
  if (measures.complete) measures.peak_error = (measures.peak_position - place).head<2>().norm();
  return measures;
}

}  // namespace sas_motion
