// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "evaluation/report.hpp"
#include "sas_motion/imaging/focus_bench.hpp"

namespace sas_motion::imaging {

/// What an image along these poses is like beside the error-free one, by backprojection, by that and autofocus
/// (autofocus_...) and by the compensation of line-of-sight errors (compensated_...): pslr_, islr_ [dB], irw_ [of the
/// error-free one] of the cuts along and in range, peak_loss [dB], peak_error [m]. And why: the aperture errors path,
/// line_of_sight, along [m] and in wavelengths, and speed, that of the estimate along the track less the true one
/// [m/s]. Without a peak whose side lobes lie inside the image its measures are left out.
Named<double> imageMeasures(FocusBench& bench, const std::vector<PingPose>& poses, double wavelength);

/// Of the middle of the aperture [m].
double horizontalError(const std::vector<PingPose>& estimate, const std::vector<PingPose>& truth);

}  // namespace sas_motion::imaging
