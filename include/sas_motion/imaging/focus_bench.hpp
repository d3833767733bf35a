// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/point_target.hpp"
#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion::imaging {

/// Measures of how sharp an image is.
struct ImageMeasures {
  std::vector<PointTargetMeasures> targets;  ///< in the order of the settings
  double whole_image_islr = 0;               ///< about the first target [dB]
  double entropy = 0;                        ///< [nat]
};
struct FocusedImage : ImageMeasures {
  Image image;
};

/// Focuses and measures the images of several trajectories from the same echoes, simulated on the true track. Poses are
/// those at the pings, in the frame of the aperture.
class FocusBench {
 public:
  /// `times` are those of the pings [s]. Keeps a reference to the settings. Throws std::invalid_argument where the
  /// scene needs more than memory_limit or the margin is too small.
  FocusBench(const FocusSettings& settings, std::vector<double> times, std::vector<PingPose> truth, int threads);

  /// The image along the true track; peak losses refer to its peaks.
  const FocusedImage& errorFree() const { return error_free_; }
  /// Trajectory error with the line of sight towards the first target.
  ApertureTrajectoryError error(const std::vector<PingPose>& poses) const;
  /// The image by backprojection along these poses.
  FocusedImage focus(const std::vector<PingPose>& poses);
  /// The image by compensateMotion() along these poses and backprojection on the straight track.
  FocusedImage compensate(const std::vector<PingPose>& poses);
  /// The autofocused image of one that focus() made with these poses.
  FocusedImage autofocus(const FocusedImage& focused, const std::vector<PingPose>& poses) const;

 private:
  FocusedImage backprojected(const EchoLines& lines, const std::vector<PingPose>& poses) const;
  FocusedImage measured(Image image, const std::vector<PingPose>& poses) const;
  PointTargetMeasures measuredTarget(const Image& image, const std::vector<PingPose>& poses, std::size_t target) const;

  const FocusSettings& settings_;
  std::vector<double> times_;
  std::vector<PingPose> truth_;
  int threads_;
  ImageGrid grid_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<double> reference_powers_;  // of the targets' peaks in the error-free image
  EchoLines lines_;
  FocusedImage error_free_;
};

/// The part of the track that is focused.
struct FocusWindow {
  double start = 0, duration = 0;  ///< start counts from the bag's first truth [s]
  double speed = 0;                ///< mean speed over ground [m/s]
  double ping_rate = 0;            ///< [Hz]
  std::size_t pings = 0;
  ApertureFrame frame;
};

/// The measures of an image and the name of its files.
struct FocusImage : ImageMeasures {
  std::string stem;
};

struct FocusedTrajectory {
  std::string name, topic;
  ApertureTrajectoryError error;  ///< with the line of sight towards the first target
  FocusImage image;
  std::optional<FocusImage> autofocused;
};

struct FocusResult {
  std::string bag;  ///< or another source of the trajectories
  FocusSettings settings;
  std::vector<Eigen::Vector3d> places;  ///< of the targets, in the frame of the aperture [m]
  FocusWindow window;
  std::vector<FocusedTrajectory> trajectories;  ///< truth first
};

/// Focuses and measures the image along these poses and writes it as FOLDER/NAME.npy; with `autofocus` also the
/// autofocused image as FOLDER/NAME_autofocus.npy.
FocusedTrajectory focusAlong(FocusBench& bench, const std::vector<PingPose>& poses, const std::string& folder,
                             const std::string& name, bool autofocus);

}  // namespace sas_motion::imaging
