// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/focus_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/image.hpp"
#include "sas_motion/imaging/motion_compensation.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kHalfChip = 64;  // pixels: 25 resolutions, so that ten null widths of a tapered aperture fit

double lengthOf(const std::vector<PingPose>& poses) {
  return (poses.back().position - poses.front().position).head<2>().norm();
}

/// Compressed echoes on the true track.
EchoLines simulatedLines(const FocusSettings& settings, const std::vector<PingPose>& truth, const ImageGrid& grid,
                         int threads) {
  const EchoOptions echo{{}, settings.noise, settings.seed, threads};
  const CompressionOptions compression{RangeFilter::Equalized, RangeWindow::Rectangular, threads};
  return compressRange(
      simulateEchoes(settings.sonar, echoPaths(settings.sonar, truth), focusScene(settings, grid), echo),
      settings.sonar, compression);
}

void requireMemory(const FocusSettings& settings, const ImageGrid& grid, std::size_t lines) {
  const double needed = memoryNeeded(settings, grid, lines);
  if (needed > settings.memory_limit)
    throw std::invalid_argument(
        fmt::format("{} lines, {} x {} pixels and the scene need {:.0f} MB but may have {:.0f} MB; set a shorter "
                    "aperture.duration, a smaller image.margin or speckle.density, or raise memory_limit",
                    lines, grid.rows, grid.columns, needed / 1e6, settings.memory_limit / 1e6));
}

FocusImage written(const FocusedImage& focused, const std::string& folder, const std::string& stem) {
  makeFolder(folder);
  writeImage(folder + "/" + stem, focused.image);
  return {focused, stem};
}

}  // namespace

FocusBench::FocusBench(const FocusSettings& settings, std::vector<double> times, std::vector<PingPose> truth,
                       int threads)
    : settings_(settings),
      times_(std::move(times)),
      truth_(std::move(truth)),
      threads_(threads),
      grid_(focusGrid(settings, lengthOf(truth_), kHalfChip)),
      places_(targetPlaces(settings)),
      reference_powers_(places_.size(), 1.0) {
  requireMemory(settings, grid_, truth_.size() * static_cast<std::size_t>(settings.sonar.receivers));
  lines_ = simulatedLines(settings, truth_, grid_, threads_);
  error_free_ = focus(truth_);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    reference_powers_[i] = std::max(error_free_.targets[i].range.peak_power, error_free_.targets[i].along.peak_power);
    error_free_.targets[i].peak_loss = 0;
  }
}

ApertureTrajectoryError FocusBench::error(const std::vector<PingPose>& poses) const {
  return apertureTrajectoryError(settings_.sonar, times_, truth_, poses, places_.front());
}

FocusedImage FocusBench::focus(const std::vector<PingPose>& poses) {
  lines_.paths = echoPaths(settings_.sonar, poses);
  return backprojected(lines_, poses);
}

FocusedImage FocusBench::compensate(const std::vector<PingPose>& poses) {
  lines_.paths = echoPaths(settings_.sonar, poses);
  const CompensationOptions options{0, settings_.starboard, threads_};
  return backprojected(compensateMotion(lines_, fitTrack(lines_), settings_.sonar.bandwidth, options), poses);
}

FocusedImage FocusBench::autofocus(const FocusedImage& focused, const std::vector<PingPose>& poses) const {
  return measured(phaseGradientAutofocus(focused.image, {}).image, poses);
}

/// Moves the grid to where the trajectory's error moves the image.
FocusedImage FocusBench::backprojected(const EchoLines& lines, const std::vector<PingPose>& poses) const {
  const BackprojectionOptions options{threads_, settings_.memory_limit};
  ImageGrid grid = grid_;
  grid.origin += error(poses).image_shift;
  return measured(backproject(lines, grid, options), poses);
}

FocusedImage FocusBench::measured(Image image, const std::vector<PingPose>& poses) const {
  FocusedImage result;
  for (std::size_t target = 0; target < places_.size(); ++target)
    result.targets.push_back(measuredTarget(image, poses, target));
  result.whole_image_islr = wholeImageIslr(image, result.targets.front());
  result.entropy = imageEntropy(image);
  result.image = std::move(image);
  return result;
}

/// Searches for the peak at the place to which the trajectory's error moves it, but measures its error from the target.
PointTargetMeasures FocusBench::measuredTarget(const Image& image, const std::vector<PingPose>& poses,
                                               std::size_t target) const {
  const Eigen::Vector3d& place = places_[target];
  const auto error = apertureTrajectoryError(settings_.sonar, times_, truth_, poses, place);
  const ChipOptions chip{kHalfChip, searchRadius(settings_, grid_, kHalfChip), reference_powers_[target]};
  auto measures = measurePointTarget(image, place + error.image_shift, chip);
  if (measures.complete) measures.peak_error = (measures.peak_position - place).head<2>().norm();
  return measures;
}

FocusedTrajectory focusAlong(FocusBench& bench, const std::vector<PingPose>& poses, const std::string& folder,
                             const std::string& name, bool autofocus) {
  FocusedTrajectory result{name, "", bench.error(poses), {}, std::nullopt};
  const FocusedImage focused = bench.focus(poses);
  result.image = written(focused, folder, name);
  if (autofocus) result.autofocused = written(bench.autofocus(focused, poses), folder, name + "_autofocus");
  return result;
}

}  // namespace sas_motion::imaging
