// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/fourier.hpp"

namespace sas_motion::imaging {

/// The bin where the gap in a spectrum is in the middle: opposite to the circular centre of its energy.
std::size_t spectralGap(const Spectrum& spectrum);

/// A periodic line `factor` times as dense, by zeros in the gap of its spectrum. Magnitudes are those of the line; the
/// carrier is taken off.
Spectrum oversample(const Spectrum& line, int factor);

/// A periodic line between its samples, at this position [samples]; the carrier is taken off. Lines to be compared are
/// given the same gap.
std::complex<double> valueAt(const Spectrum& spectrum, std::size_t gap, double position);

}  // namespace sas_motion::imaging
