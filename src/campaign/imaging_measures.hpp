// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "evaluation/report.hpp"
#include "sas_motion/imaging/focus_bench.hpp"

namespace sas_motion::imaging {

/// Measures of the first target in the image along these poses against the error-free image: by backprojection, with
/// autofocus (autofocus_...) and by compensation of line-of-sight errors (compensated_...). They are pslr_, islr_ [dB]
/// and irw_ [-] of the cuts along and in range, peak_loss [dB] and peak_error [m]; they are left out where the side
/// lobes reach beyond the image. The causes: the aperture errors path, line_of_sight and along [m] and in wavelengths,
/// and speed, the estimated speed along the track less the true one [m/s].
Named<double> imageMeasures(FocusBench& bench, const std::vector<PingPose>& poses, double wavelength);

/// Horizontal error of the middle of the aperture [m].
double horizontalError(const std::vector<PingPose>& estimate, const std::vector<PingPose>& truth);

}  // namespace sas_motion::imaging
