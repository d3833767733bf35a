// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/echo_lines.hpp"

namespace sas_motion::imaging {

enum class RangeFilter {
  Matched,    ///< the chirp's conjugate: the highest ratio of signal to noise
  Equalized,  ///< flat over the band: a sinc without the chirp's Fresnel ripple
};
enum class RangeWindow { Rectangular, Hamming };

struct CompressionOptions {
  RangeFilter filter = RangeFilter::Matched;
  RangeWindow window = RangeWindow::Rectangular;  ///< over the band
  int threads = 1;
};

/// Compresses raw echoes in range; a peak has its scatterer's amplitude, phases and delays stay, and lines become a
/// pulse shorter. A line with a sample that is not finite becomes zero and counts as left out.
EchoLines compressRange(const EchoLines& raw, const SonarDescription& sonar, const CompressionOptions& options);

}  // namespace sas_motion::imaging
