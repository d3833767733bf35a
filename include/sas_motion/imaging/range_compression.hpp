// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/echo_lines.hpp"

namespace sas_motion::imaging {

enum class RangeFilter {
  Matched,    ///< the chirp's conjugate: the best against noise
  Equalized,  ///< flat over the band: a sinc without the chirp's Fresnel ripple
};
enum class RangeWindow { Rectangular, Hamming };

struct CompressionOptions {
  RangeFilter filter = RangeFilter::Matched;
  RangeWindow window = RangeWindow::Rectangular;  ///< over the band
  int threads = 1;
};

/// Raw echoes to range-compressed ones, where a scatterer's amplitude is that of its peak. Phases and delays stay;
/// lines lose the length of a pulse. A line in which an echo is not finite becomes zero and is counted.
EchoLines compressRange(const EchoLines& raw, const SonarDescription& sonar, const CompressionOptions& options);

}  // namespace sas_motion::imaging
