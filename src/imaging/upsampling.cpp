// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/upsampling.hpp"

#include <algorithm>

#include "imaging/backprojection_kernel.hpp"
#include "sas_motion/imaging/interpolator.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kTaps = Interpolator::kTaps, kBefore = kTaps / 2 - 1;

/// The kernel less a twelfth of its second difference on the fine grid.
double raisedKernel(double x) {
  constexpr double kFine = 1.0 / Upsampling::kFactor;
  return Interpolator::kernel(x) -
         (Interpolator::kernel(x + kFine) - 2 * Interpolator::kernel(x) + Interpolator::kernel(x - kFine)) / 12;
}

}  // namespace

Upsampling::Upsampling() : taps_(kTaps * kUpsamplingLanes) {
  for (int tap = 0; tap < kTaps; ++tap)
    for (int phase = 0; phase < kFactor; ++phase)
      taps_[static_cast<std::size_t>(tap * kUpsamplingLanes + phase)] =
          static_cast<float>(raisedKernel(static_cast<double>(phase) / kFactor + kBefore - tap));
}

void Upsampling::apply(const std::complex<float>* line, int samples, float* fine, std::ptrdiff_t plane) const {
  upsampleLine(line, samples, {taps_.data(), kTaps, kBefore, kFactor}, fine, plane);
}

}  // namespace sas_motion::imaging
