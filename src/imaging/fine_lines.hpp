// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "imaging/backprojection_kernel.hpp"
#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/interpolator.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {

constexpr std::size_t kBatch = 32;  ///< lines upsampled at a time; it bounds the work space

/// Lines first ... first + kBatch - 1, upsampled for linear interpolation, with zeros on both sides as far as a tile
/// reaches beyond its centre. Linear interpolation damps a wave of w radians a fine sample by w^2 / 12 on average; the
/// taps raise it by as much beforehand, so only the ripple about the average is left: below -60 dB of the line's
/// energy, a tenth of what it is without.
class FineLines {
 public:
  static constexpr int kFactor = 9;  ///< fine samples a sample

  FineLines(const EchoLines& lines, double reach)
      : lines_(lines),
        padding_(static_cast<int>(2 * reach / lines.sound_speed * lines.sample_rate * kFactor) + 4 * kTileLanes),
        length_(static_cast<std::size_t>(lines.samples) * kFactor + 4 * static_cast<std::size_t>(padding_)),
        values_(2 * kBatch * length_) {
    for (int tap = 0; tap < kTaps; ++tap)
      for (int phase = 0; phase < kFactor; ++phase)
        taps_[tap * kUpsamplingLanes + phase] =
            static_cast<float>(raisedKernel(static_cast<double>(phase) / kFactor + kBefore - tap));
  }

  void load(std::size_t first, int threads) {
    first_ = first;
    forEachTask(std::min(kBatch, lines_.paths.size() - first), threads, [&](std::size_t i) {
      upsampleLine(lines_.line(first + i), lines_.samples, {taps_.data(), kTaps, kBefore, kFactor},
                   fine(i, 2 * padding_), plane());
    });
  }
  /// Points the tile's line at the sample before the centre's echo. False where the line has no echo from the tile.
  bool aim(std::size_t line, double path_length, TileLine& result) {
    const double position = lines_.position(path_length) * kFactor, floor = std::floor(position);
    if (!(floor > -static_cast<double>(padding_) &&
          floor < static_cast<double>(lines_.samples) * kFactor + static_cast<double>(padding_)))
      return false;
    const auto offset = static_cast<std::ptrdiff_t>(floor) + 2 * padding_;
    result.position = static_cast<float>(position - floor);
    result.real = fine(line - first_, offset);
    result.imaginary = result.real + plane();
    return true;
  }
  static double bytes(const EchoLines& lines, double reach) {
    return 2.0 * kBatch * sizeof(float) *
           (lines.samples * kFactor + 8 * reach / lines.sound_speed * lines.sample_rate * kFactor + 16 * kTileLanes);
  }

 private:
  static constexpr int kTaps = Interpolator::kTaps, kBefore = kTaps / 2 - 1;

  /// The kernel less a twelfth of its second difference on the fine grid.
  static double raisedKernel(double x) {
    constexpr double kFine = 1.0 / kFactor;
    return Interpolator::kernel(x) -
           (Interpolator::kernel(x + kFine) - 2 * Interpolator::kernel(x) + Interpolator::kernel(x - kFine)) / 12;
  }
  /// Fine sample `offset` of a line, and from there to its imaginary part.
  float* fine(std::size_t line, std::ptrdiff_t offset) {
    return values_.data() + 2 * line * length_ + (interleaved_ ? 2 : 1) * offset;
  }
  std::ptrdiff_t plane() const { return interleaved_ ? 1 : static_cast<std::ptrdiff_t>(length_); }

  const EchoLines& lines_;
  std::array<float, kTaps * kUpsamplingLanes> taps_{};
  bool interleaved_ = kernelInterleaves();
  std::ptrdiff_t padding_;
  std::size_t length_, first_ = 0;
  std::vector<float> values_;
};

}  // namespace sas_motion::imaging
