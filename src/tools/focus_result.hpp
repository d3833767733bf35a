// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/point_target.hpp"
#include "sas_motion/imaging/track_window.hpp"
#include "sas_motion/imaging/trajectory_error.hpp"

namespace sas_motion {

/// The stretch of the track that is focused.
struct FocusWindow {
  double start = 0, duration = 0;  ///< after the bag's first truth, and long [s]
  double speed = 0;                ///< mean over ground [m/s]
  double ping_rate = 0;            ///< [Hz]
  std::size_t pings = 0;
  imaging::ApertureFrame frame;
};

/// How sharp one image is.
struct FocusImage {
  std::string stem;                                   ///< name of its files
  std::vector<imaging::PointTargetMeasures> targets;  ///< in the order of the settings
  double whole_image_islr = 0;                        ///< about the first target [dB]
  double entropy = 0;                                 ///< [nat]
};

/// One trajectory and its images.
struct FocusedTrajectory {
  std::string name, topic;
  imaging::ApertureTrajectoryError error;  ///< towards the first target
  FocusImage image;
  std::optional<FocusImage> autofocused;
};

struct FocusResult {
  std::string bag;
  imaging::FocusSettings settings;
  FocusWindow window;
  std::vector<FocusedTrajectory> trajectories;  ///< truth first
};

/// The measures of all trajectories (JSON).
std::string focusDocument(const FocusResult& result);
/// The same in short, for a terminal.
std::string focusTable(const FocusResult& result);

}  // namespace sas_motion
