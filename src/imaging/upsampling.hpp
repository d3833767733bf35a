// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace sas_motion::imaging {

/// Lines on a finer grid, for linear interpolation. Linear interpolation damps a wave of w radians a fine sample by w^2
/// / 12 on average; the taps raise it by as much beforehand, so that only the ripple about the average is left: below
/// -60 dB of the line's energy, a tenth of what it is without.
class Upsampling {
 public:
  static constexpr int kFactor = 9;  ///< fine samples a sample
  static constexpr int kSlack = 7;

  Upsampling();
  /// Fine samples 0 ... kFactor samples - 1, and up to kSlack more of no meaning, in the kernel's order.
  void apply(const std::complex<float>* line, int samples, float* fine, std::ptrdiff_t plane) const;

 private:
  std::vector<float> taps_;  // kTaps x kUpsamplingLanes
};

}  // namespace sas_motion::imaging
