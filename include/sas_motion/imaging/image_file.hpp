// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// Writes STEM.npy, the complex image as a NumPy array of complex64, rows x columns, and STEM.json, its axes in metres:
/// origin, range_axis, along_axis, range_step, along_step, rows, columns. Each file is whole or not there. Throws
/// std::runtime_error naming the file.
void writeImage(const std::string& stem, const Image& image);

}  // namespace sas_motion::imaging
