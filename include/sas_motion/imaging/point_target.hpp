// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging {

/// Measures of a cut through a point target, 32 times oversampled. [dB] are of power.
struct CutMeasures {
  double irw = 0;        ///< width of the main lobe at -3 dB of its peak, interpolated [m]
  double pslr = 0;       ///< highest side lobe over the peak [dB]
  double islr = 0;       ///< energy of the side lobes over that of the main lobe, both within `extent` [dB]
  double main_lobe = 0;  ///< between the first nulls [m]
  double extent =
      0;  ///< each side of the peak: side lobes reach from the first null to here, ten times half the main lobe [m]
  double peak_position = 0;  ///< from the cut's first sample [m]
  double peak_power = 0;     ///< |.|^2
  bool complete = false;     ///< main lobe and extent lie inside the cut; else what is missing is left out
};
constexpr int kOversampling = 32;

/// `cut` is sampled at least at its bandwidth every `step` metres; its spectrum may lie anywhere. Nulls are the first
/// minima on either side of the peak: a main lobe ended at -3 dB would report an ISLR of about -3 dB whatever the side
/// lobes.
CutMeasures measureCut(const std::vector<std::complex<double>>& cut, double step);

struct PointTargetMeasures {
  CutMeasures range, along;                                 ///< cuts through the peak
  Eigen::Vector3d peak_position = Eigen::Vector3d::Zero();  ///< in the local frame [m]
  double peak_error = 0;                                    ///< from the true position, in the image plane [m]
  double peak_loss = 0;                                     ///< of the reference peak's power over this one's [dB]
  bool complete = false;                                    ///< a chip of the wanted size fits into the image
};

struct ChipOptions {
  int half_size = 32;          ///< pixels each side of the brightest pixel
  double search_radius = 1;    ///< the brightest pixel is looked for this far around the true position [m]
  double reference_power = 1;  ///< peak power without errors
};

/// Measures the brightest point near the true position.
PointTargetMeasures measurePointTarget(const Image& image, const Eigen::Vector3d& truth, const ChipOptions& options);

/// Energy outside the main lobe over energy inside it, in the whole image [dB]. The main lobe is the rectangle between
/// the nulls of both cuts.
double wholeImageIslr(const Image& image, const PointTargetMeasures& target);

/// Entropy of the image's power, -sum p ln p with p the share of a pixel [nat]: the lower, the sharper.
double imageEntropy(const Image& image);

}  // namespace sas_motion::imaging
