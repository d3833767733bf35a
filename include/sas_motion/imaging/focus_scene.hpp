// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sas_motion/imaging/image.hpp"
#include "sas_motion/imaging/scene.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// Where the sonar listens.
struct ApertureSettings {
  std::optional<double> start;  ///< after the bag's first truth [s]; none: where the track is straightest
  double duration = 0;          ///< [s]; 0: the time of one synthetic aperture, r0 lambda / (D v)
  bool speed_locked = true;  ///< pings just often enough to sample the aperture evenly at the window's mean speed; else
                             ///< at the sonar's ping rate
  double longest_gap = 0.5;  ///< between two poses of a trajectory that is interpolated over [s]
};

/// A point on the bottom.
struct TargetSettings {
  double range = 30;  ///< slant range abeam of the middle of the aperture [m]
  double along = 0;   ///< forward of abeam [m]
};

/// Speckle, and an upright block that throws a shadow.
struct SpeckleSettings {
  double density = 0;                       ///< scatterers a square metre; 0: no speckle
  double level = 5;                         ///< power of a square metre of bottom over a target's [dB]
  bool block = false;                       ///< whether there is one
  double block_along = 0;                   ///< of its middle from the first target's [m]
  double block_range = 1;                   ///< of its middle, outwards from the first target [m]
  Eigen::Vector3d block_size{1, 0.5, 0.5};  ///< along track, in range, upwards [m]
};

/// The pixels.
struct GridSettings {
  double margin = 3;      ///< around the targets [m]
  double range_step = 0;  ///< [m]; 0: 0.4 of the resolution
  double along_step = 0;  ///< [m]; 0: 0.4 of the resolution
};

/// What is looked at, by which sonar, and how the image is sampled.
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

/// Places in the frame of the aperture, whose bottom is z = 0.
std::vector<Eigen::Vector3d> targetPlaces(const FocusSettings& settings);

/// The pixels around the targets, rows outwards from the track, for an aperture of this length [m]. `half_chip` pixels
/// on each side of a target and what lies between are inside; throws std::invalid_argument naming the margin needed
/// where they are not.
ImageGrid focusGrid(const FocusSettings& settings, double aperture_length, int half_chip);

/// How far from its expected place a target may be looked for: as far as its chip stays inside, and no nearer to
/// another target [m].
double searchRadius(const FocusSettings& settings, const ImageGrid& grid, int half_chip);

/// Targets of amplitude 1, and the speckle over the grid.
Scene focusScene(const FocusSettings& settings, const ImageGrid& grid);

/// What echoes, scene and image take at most [byte].
double memoryNeeded(const FocusSettings& settings, const ImageGrid& grid, std::size_t lines);

}  // namespace sas_motion::imaging
