// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

struct AutofocusOptions {
  int max_iterations = 10;
  double tolerance = 0.02;       ///< stops when an iteration's phase has less RMS than this [rad]
  double strongest_share = 0.5;  ///< the share of rows with the brightest peaks that is used
};

struct Autofocus {
  Image image;  ///< focused
  std::vector<double>
      phase;  ///< taken off each bin of the along-track spectrum, from the gap upwards, without mean and trend [rad]
  int iterations = 0;
  bool converged = false;
};

/// Phase gradient autofocus [Wahl1994]: the phase error common to all rows, over the along-track wave number, which is
/// the place in the aperture. For patches that all of the aperture saw and that are short against it. A mean and a
/// trend of phase move the image and cannot be found.
Autofocus phaseGradientAutofocus(const Image& image, const AutofocusOptions& options);

}  // namespace sas_motion::imaging
