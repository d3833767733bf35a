// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/point_target.hpp"
#include "sas_motion/imaging/trajectory_error.hpp"

namespace sas_motion::imaging {

/// An image and how sharp it is.
struct FocusedImage {
  Image image;
  std::vector<PointTargetMeasures> targets;  ///< in the order of the settings
  double whole_image_islr = 0;               ///< about the first target [dB]
  double entropy = 0;                        ///< [nat]
};

/// Focuses and measures the image of one trajectory after another, from echoes that are made once, on the true track.
/// Poses are those of the pings, in the frame of the aperture.
class FocusBench {
 public:
  /// `times` of the pings [s]. Keeps a reference to the settings. Throws std::invalid_argument where the scene needs
  /// more than their memory_limit or their margin is too small.
  FocusBench(const FocusSettings& settings, std::vector<double> times, std::vector<PingPose> truth, int threads);

  /// The image along the true track. Its peaks are the reference of all others' loss.
  const FocusedImage& errorFree() const { return error_free_; }
  /// Towards the first target.
  ApertureTrajectoryError error(const std::vector<PingPose>& poses) const;
  /// By backprojection along these poses.
  FocusedImage focus(const std::vector<PingPose>& poses);
  /// By compensateMotion() along these poses, and backprojection on the straight track.
  FocusedImage compensate(const std::vector<PingPose>& poses);
  /// What autofocus makes of an image that focus() made of these poses.
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

}  // namespace sas_motion::imaging
