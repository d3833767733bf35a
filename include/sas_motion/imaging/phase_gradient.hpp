// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

struct AutofocusOptions {
  int max_iterations = 10;
  double tolerance = 0.02;       ///< stops when an iteration's phase has less RMS than this [rad]
  double strongest_share = 0.5;  ///< share of the rows that is used: those with the brightest peaks
};

struct Autofocus {
  Image image;                ///< focused
  std::vector<double> phase;  ///< removed from each bin of the along-track spectrum, from the gap upwards [rad]
  int iterations = 0;
  bool converged = false;
};

/// Phase gradient autofocus [Wahl1994]: removes the phase error common to all rows over the along-track wave number,
/// which stands for the place in the aperture. Needs a patch that the whole aperture sees and that is short against it.
/// Mean and trend of the phase only move the image and are not estimated.
Autofocus phaseGradientAutofocus(const Image& image, const AutofocusOptions& options);

}  // namespace sas_motion::imaging
