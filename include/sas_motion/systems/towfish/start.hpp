// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::towfish {

/// How an estimator starts from the first measurements.
struct StartOptions {
  double window = 5;                      ///< measurements gathered before the first estimate [s]
  double position_sigma = 5;              ///< of the state found in the window [m]
  double heading_sigma = 5 * kRadPerDeg;  ///< [rad]
  double speed_sigma = 0.5;               ///< [m/s]
};

/// The belief at `stamp` from the measurements of the start window, or nothing without a position and a heading.
///
/// Each quantity is the reading that most others agree with, so that outliers, even a majority of scattered ones, do
/// not start the estimate off at a wrong place. Positions are first moved to `stamp` along the agreed heading and
/// speed.
std::optional<Gaussian<kStates>> startingBelief(Stamp stamp, const std::vector<Measurement>& window,
                                                const StartOptions& options, double current_sigma);

}  // namespace sas_motion::towfish
