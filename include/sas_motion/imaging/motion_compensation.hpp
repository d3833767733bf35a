// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// A straight, level track.
struct StraightTrack {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< horizontal unit vector of travel
};

/// The least-squares line through the lines' phase centres, at their mean height. Throws std::invalid_argument for
/// fewer than two lines or a track without length.
StraightTrack fitTrack(const EchoLines& lines);

struct CompensationOptions {
  double bottom = 0;       ///< height of the bottom [m]
  bool starboard = false;  ///< looks to starboard of the track, else to port
  int threads = 1;
};

/// The paper's compensation of line-of-sight errors, (9)-(12) of paper C and its part C.5: with the sway dx away from
/// the target and the heave dz off the ideal track, a target at slant range r and height h below is too far by
/// dr = (x/r) dx + (h/r) dz, x = sqrt(r^2 - h^2). Each range bin is multiplied by exp(+j 4 pi f0 dr / c) and, where dr
/// exceeds a quarter of a range bin c/4B, shifted by dr. The resulting paths are monostatic, at the phase centres'
/// places along the ideal track. Without stop and hop, dx and dz grow by half the receiver's velocity until the echo
/// arrives. Exact at broadside only, unlike backproject() on the true paths. `bandwidth` is that of the chirp [Hz].
EchoLines compensateMotion(const EchoLines& lines, const StraightTrack& track, double bandwidth,
                           const CompensationOptions& options);

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
