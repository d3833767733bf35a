// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// Fast factorised backprojection [Ulander2003]: images of short apertures on few angles are merged by fours into those
/// of longer apertures on more angles, and at last into the grid. For n lines and n x n pixels it takes n^2 log n
/// instead of n^3 steps. Works on any path whose sonar lies on the side of the grid that range_axis points away from.
/// Image error about -50 dB of backproject()'s image. The same bits for any number of threads. Throws
/// std::invalid_argument for a bad grid, or one that reaches below or behind the sonar.
Image backprojectFactorized(const EchoLines& lines, const ImageGrid& grid, int threads);

}  // namespace sas_motion::imaging
