// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/scene.hpp"

namespace sas_motion::imaging {

struct EchoOptions {
  std::vector<double> slant_errors;  ///< injected one-way range error of each line [m]; empty: none
  double noise =
      0;  ///< standard deviation of the complex white noise of a sample; a scatterer's chirp has its own amplitude
  std::uint64_t seed = 0;  ///< of the noise
  int threads = 1;
};

/// The raw echoes of a scene: chirps at their two-way delays, weighted by the beam, hidden by blocks; no spreading
/// loss, as after time-varied gain. A line begins at the near range and is a pulse longer than the swath. The same bits
/// for any number of threads. Throws std::invalid_argument where slant_errors are not one a line.
EchoLines simulateEchoes(const SonarDescription& sonar, const std::vector<EchoPath>& paths, const Scene& scene,
                         const EchoOptions& options);

}  // namespace sas_motion::imaging
