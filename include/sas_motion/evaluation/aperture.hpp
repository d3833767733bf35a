// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/evaluation/scores.hpp"

namespace sas_motion::towfish {

/// Splits the run into windows of one synthetic-aperture time T_a = r0 lambda / (D v), removes mean and linear trend
/// from the error in each and returns the RMS of what is left. `time` [s] rises; `along` and `across` [m]; `speed`
/// [m/s].
ApertureError apertureError(const std::vector<double>& time, const std::vector<double>& along,
                            const std::vector<double>& across, double speed, const ApertureOptions& options);

}  // namespace sas_motion::towfish
