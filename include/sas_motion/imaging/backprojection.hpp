// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

struct BackprojectionOptions {
  int threads = 1;
  double memory_limit = 2e9;  ///< for the image and its working space [byte]
  double half_angle = 2;      ///< of the beam that is used, about broadside to a tile's middle [rad]; above pi/2: all
};

/// Time-domain backprojection of range-compressed lines: I(p) = sum over lines of s(L(p)) exp(+j 2 pi f0 L(p) / c),
/// with the exact path L(p), on the widest vectors of this machine. Lines whose path is not finite are left out.
/// Gives the same bits for any number of threads. The work space does not grow with the number of lines.
/// Throws std::invalid_argument for a bad grid, or one that needs more than memory_limit.
Image backproject(const EchoLines& lines, const ImageGrid& grid, const BackprojectionOptions& options);

/// The same in double, pixel by pixel: the reference.
Image backprojectReference(const EchoLines& lines, const ImageGrid& grid, int threads);

/// Name of the vector instructions that backproject() uses here.
std::string backprojectionTarget();

/// Fast factorised backprojection [Ulander2003]: merges images of short apertures on few angles by fours into those of
/// longer apertures on more angles, and at last into the grid. For n lines and n x n pixels it takes n^2 log n instead
/// of n^3 steps; its image differs from backproject()'s by about -50 dB. Gives the same bits for any number of threads.
/// Throws std::invalid_argument for a bad grid, or one that reaches below or behind the sonar (along range_axis).
Image backprojectFactorized(const EchoLines& lines, const ImageGrid& grid, int threads);

}  // namespace sas_motion::imaging
