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
  double half_angle = 2;  ///< lines that see a tile's middle further from broadside than this leave the tile out [rad];
                          ///< above pi/2: none
};

/// Time-domain backprojection of range-compressed lines: I(p) = sum over lines of s(L(p)) exp(+j 2 pi f0 L(p) / c),
/// with the exact path L(p). Lines whose path is not finite are left out. In float about tile centres in double, on the
/// widest vectors of this machine; the same bits for any number of threads. The work space does not grow with the
/// number of lines. Throws std::invalid_argument for a bad grid, or one that needs more than memory_limit.
Image backproject(const EchoLines& lines, const ImageGrid& grid, const BackprojectionOptions& options);

/// The same in double, pixel by pixel: the yardstick.
Image backprojectReference(const EchoLines& lines, const ImageGrid& grid, int threads);

/// Name of the vector instructions that backproject() uses here.
std::string backprojectionTarget();

}  // namespace sas_motion::imaging
