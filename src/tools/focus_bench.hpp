// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "focus_window.hpp"
#include "sas_motion/imaging/echo_lines.hpp"

namespace sas_motion {

struct FocusOptions {
  std::string bag, out;  ///< the bag, for errors, and the folder for images
  int jobs = 1;          ///< threads
  bool autofocus = false;
};

/// Focuses, measures and writes the image of one trajectory after another, from echoes that are made once, on the true track.
class FocusBench {
 public:
  /// Keeps references to all three. Throws std::runtime_error where the scene needs more than memory_limit, std::invalid_argument for a margin too small.
  FocusBench(const FocusOptions& options, const imaging::FocusSettings& settings, const FocusPings& pings);

  /// `which` is the trajectory's place; truth is the first, and its image's peaks are the reference of the others.
  FocusedTrajectory focus(const RecordedTrajectory& trajectory, std::size_t which);

 private:
  FocusImage measured(const imaging::Image& image, std::size_t which, const std::string& stem);
  imaging::PointTargetMeasures measuredTarget(const imaging::Image& image, std::size_t which, std::size_t target);

  const FocusOptions& options_;
  const imaging::FocusSettings& settings_;
  const FocusPings& pings_;
  imaging::ImageGrid grid_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<double> reference_powers_;  // of the peaks in the first image measured, truth's
  imaging::EchoLines lines_;
};

}  // namespace sas_motion
