// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// Measures of a cut through a point target, oversampled kOversampling times; dB of power.
struct CutMeasures {
  double irw = 0;            ///< width of the main lobe at -3 dB of its peak, interpolated [m]
  double pslr = 0;           ///< highest side lobe over the peak [dB]
  double islr = 0;           ///< energy of the side lobes over that of the main lobe, both within `extent` [dB]
  double main_lobe = 0;      ///< between the first nulls [m]
  double extent = 0;         ///< from the peak to the end of the side lobes: ten times half the main lobe [m]
  double peak_position = 0;  ///< from the cut's first sample [m]
  double peak_power = 0;     ///< |.|^2
  bool complete = false;     ///< main lobe and extent lie inside the cut; else the part inside is measured
};
constexpr int kOversampling = 32;

/// `cut` has a sample every `step` [m], at least at its bandwidth; its spectrum may lie anywhere. The main lobe ends at
/// the first minima, not at -3 dB, where the ISLR would be about -3 dB for any side lobes.
CutMeasures measureCut(const std::vector<std::complex<double>>& cut, double step);

struct PointTargetMeasures {
  CutMeasures range, along;                                 ///< cuts through the peak
  Eigen::Vector3d peak_position = Eigen::Vector3d::Zero();  ///< in the local frame [m]
  double peak_error = 0;                                    ///< distance from the true position in the image plane [m]
  double peak_loss = 0;                                     ///< power of the reference peak over this one's [dB]
  bool complete = false;                                    ///< a chip of the wanted size fits into the image
};

struct ChipOptions {
  int half_size = 32;          ///< pixels each side of the brightest pixel
  double search_radius = 1;    ///< of the search for the brightest pixel, about the true position [m]
  double reference_power = 1;  ///< peak power without errors
};

/// Measures the brightest point near the true position.
PointTargetMeasures measurePointTarget(const Image& image, const Eigen::Vector3d& truth, const ChipOptions& options);

/// Energy of the image outside the main lobe, the rectangle between the nulls of both cuts, over that inside [dB].
double wholeImageIslr(const Image& image, const PointTargetMeasures& target);

/// Entropy of the image's power, -sum p ln p with p the share of a pixel [nat]; a sharper image has less.
double imageEntropy(const Image& image);

}  // namespace sas_motion::imaging
