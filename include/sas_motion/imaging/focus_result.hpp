// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/imaging/focus_bench.hpp"
#include "sas_motion/imaging/track_window.hpp"

namespace sas_motion::imaging {

/// The stretch of the track that is focused.
struct FocusWindow {
  double start = 0, duration = 0;  ///< after the bag's first truth, and long [s]
  double speed = 0;                ///< mean over ground [m/s]
  double ping_rate = 0;            ///< [Hz]
  std::size_t pings = 0;
  ApertureFrame frame;
};

/// How sharp one image is.
struct FocusImage {
  std::string stem;                          ///< name of its files
  std::vector<PointTargetMeasures> targets;  ///< in the order of the settings
  double whole_image_islr = 0;               ///< about the first target [dB]
  double entropy = 0;                        ///< [nat]
};

/// One trajectory and its images.
struct FocusedTrajectory {
  std::string name, topic;
  ApertureTrajectoryError error;  ///< towards the first target
  FocusImage image;
  std::optional<FocusImage> autofocused;
};

struct FocusResult {
  std::string bag;  ///< or what else the trajectories come from
  FocusSettings settings;
  std::vector<Eigen::Vector3d> places;  ///< of the targets, in the frame of the aperture [m]
  FocusWindow window;
  std::vector<FocusedTrajectory> trajectories;  ///< truth first
};

/// Focuses and measures the image along these poses and writes it as FOLDER/NAME.npy; as FOLDER/NAME_autofocus.npy also
/// what autofocus makes of it.
FocusedTrajectory focusAlong(FocusBench& bench, const std::vector<PingPose>& poses, const std::string& folder,
                             const std::string& name, bool autofocus);

}  // namespace sas_motion::imaging
