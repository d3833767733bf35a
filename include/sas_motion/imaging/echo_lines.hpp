// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include "sas_motion/imaging/echo_path.hpp"

namespace sas_motion::imaging {

/// What the receivers heard, as complex baseband: an echo by a path of length L has the phase exp(-j 2 pi f0 L / c).
/// One line a path.
struct EchoLines {
  double carrier = 0;        ///< f0 [Hz]
  double sound_speed = 0;    ///< c [m/s]
  double sample_rate = 0;    ///< [Hz]
  double first_delay = 0;    ///< of sample 0 after transmission [s]
  int samples = 0;           ///< in a line
  std::size_t left_out = 0;  ///< lines that are zero because an echo in them was not finite
  std::vector<EchoPath> paths;
  std::vector<std::complex<float>> data;  ///< lines x samples

  const std::complex<float>* line(std::size_t i) const { return data.data() + i * static_cast<std::size_t>(samples); }
  std::complex<float>* line(std::size_t i) { return data.data() + i * static_cast<std::size_t>(samples); }
  /// Where an echo by a path of this length stands in its line [samples].
  double position(double path_length) const { return (path_length / sound_speed - first_delay) * sample_rate; }
};

}  // namespace sas_motion::imaging
