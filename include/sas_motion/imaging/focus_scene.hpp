// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/image.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// The part of the track that is focused.
struct ApertureSettings {
  std::optional<double> start;  ///< after the bag's first truth [s]; none: where the track is straightest
  double duration = 0;          ///< [s]; 0: the time of one synthetic aperture, r0 lambda / (D v)
  bool speed_locked = true;     ///< pings at the rate needed at the mean speed, else at the sonar's ping rate
  double longest_gap = 0.5;     ///< between two poses that is interpolated over [s]
};

/// A point on the bottom.
struct TargetSettings {
  double range = 30;  ///< slant range abeam of the middle of the aperture [m]
  double along = 0;   ///< forward of abeam [m]
};

/// Speckle, and an upright block that throws a shadow.
struct SpeckleSettings {
  double density = 0;                       ///< of scatterers [1/m^2]; 0: no speckle
  double level = 5;                         ///< power of a square metre of bottom over a target's [dB]
  bool block = false;                       ///< whether there is a block
  double block_along = 0;                   ///< of its middle, forward of the first target [m]
  double block_range = 1;                   ///< of its middle, outwards from the first target [m]
  Eigen::Vector3d block_size{1, 0.5, 0.5};  ///< along track, in range, upwards [m]
};

struct GridSettings {
  double margin = 3;      ///< around the targets [m]
  double range_step = 0;  ///< [m]; 0: 0.4 of the resolution
  double along_step = 0;  ///< [m]; 0: 0.4 of the resolution
};

/// The sonar, the scene and the sampling of its image.
struct FocusSettings {
  SonarDescription sonar;
  ApertureSettings aperture;
  std::vector<TargetSettings> targets{TargetSettings{}};
  bool starboard = true;  ///< side of the targets
  SpeckleSettings speckle;
  GridSettings image;
  double noise = 0;           ///< standard deviation of a sample's complex noise; a target's raw echo has amplitude 1
  std::uint64_t seed = 1;     ///< of speckle and noise
  double memory_limit = 2e9;  ///< for echoes, scene and image [byte]
};

/// Duration of one synthetic aperture at the first target, r0 lambda / (D v) [s].
double apertureTime(const FocusSettings& settings, double speed);

/// The targets in the frame of the aperture, whose bottom is z = 0 [m].
std::vector<Eigen::Vector3d> targetPlaces(const FocusSettings& settings);

/// The pixels around the targets, rows outwards from the track, for an aperture of this length [m]. Throws
/// std::invalid_argument naming the margin needed where `half_chip` pixels on each side of a target do not fit.
ImageGrid focusGrid(const FocusSettings& settings, double aperture_length, int half_chip);

/// Search radius about a target: its chip stays inside the image, and no other target is nearer [m].
double searchRadius(const FocusSettings& settings, const ImageGrid& grid, int half_chip);

/// Targets of amplitude 1 and the speckle over the grid.
Scene focusScene(const FocusSettings& settings, const ImageGrid& grid);

/// Largest memory of echoes, scene and image [byte].
double memoryNeeded(const FocusSettings& settings, const ImageGrid& grid, std::size_t lines);

/// Reads the settings; the sonar is under `sonar`, or in `sonar_file`, relative to this one. Throws ConfigError.
FocusSettings readFocus(const std::string& file);

}  // namespace sas_motion::imaging
