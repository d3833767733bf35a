// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace sas_motion {

/// The synthetic aperture sonar that the aperture error is meant for: T_a = range wavelength / (element speed).
struct ApertureOptions {
  double range = 100;         ///< slant range r0 [m]
  double wavelength = 0.015;  ///< [m]
  double element = 0.1;       ///< length of the array element D [m]
};

/// The position error that blurs an image: its RMS over windows of one synthetic aperture, after removing mean and
/// linear trend in each.
struct ApertureError {
  double time = 0, wavelength = 0;
  std::size_t windows = 0;
  double across = 0, along = 0;  ///< across the heading (line of sight) and along it [m]
};

/// Splits the run into windows of one synthetic-aperture time T_a = r0 lambda / (D v). `time` [s] rises; `along` and
/// `across` [m]; `speed` [m/s].
ApertureError apertureError(const std::vector<double>& time, const std::vector<double>& along,
                            const std::vector<double>& across, double speed, const ApertureOptions& options);

}  // namespace sas_motion
