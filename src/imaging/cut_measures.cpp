// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/point_target.hpp"

namespace sas_motion::imaging {
namespace {

/// The oversampled cut's power and the bounds of its lobes.
class Lobes {
 public:
  explicit Lobes(std::vector<double> power)
      : power_(std::move(power)), peak_(std::max_element(power_.begin(), power_.end()) - power_.begin()) {
    left_null_ = firstMinimum(-1);
    right_null_ = firstMinimum(1);
  }

  /// Vertex of the parabola through the peak and its neighbours.
  double peakPosition() const {
    if (peak_ == 0 || peak_ + 1 == size()) return static_cast<double>(peak_);
    const double before = power_[peak_ - 1], at = power_[peak_], after = power_[peak_ + 1],
                 bend = before - 2 * at + after;
    return static_cast<double>(peak_) + (bend < 0 ? 0.5 * (before - after) / bend : 0.0);
  }
  double peakPower() const { return power_[peak_]; }
  double halfPowerWidth() const { return crossing(1) + crossing(-1); }
  std::ptrdiff_t mainLobe() const { return right_null_ - left_null_; }
  std::ptrdiff_t extent() const { return 10 * mainLobe() / 2; }
  bool complete() const {
    return peak_ - extent() >= 0 && peak_ + extent() < size() && left_null_ > 0 && right_null_ + 1 < size();
  }
  double highestSideLobe() const {
    double highest = 0;
    forSideLobes([&](double power) { highest = std::max(highest, power); });
    return highest;
  }
  double sideLobeEnergy() const {
    double energy = 0;
    forSideLobes([&](double power) { energy += power; });
    return energy;
  }
  double mainLobeEnergy() const {
    double energy = 0;
    for (std::ptrdiff_t i = left_null_; i <= right_null_; ++i) energy += power_[i];
    return energy;
  }

 private:
  std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(power_.size()); }
  std::ptrdiff_t firstMinimum(int direction) const {
    std::ptrdiff_t i = peak_;
    while (i + direction >= 0 && i + direction < size() && power_[i + direction] <= power_[i]) i += direction;
    return i;
  }
  /// Distance from the peak to half its power, linearly between samples.
  double crossing(int direction) const {
    const double half = power_[peak_] * std::pow(10, -0.3);
    std::ptrdiff_t i = peak_;
    while (i + direction >= 0 && i + direction < size() && power_[i + direction] > half) i += direction;
    if (i + direction < 0 || i + direction >= size()) return static_cast<double>(std::abs(i - peak_));
    return static_cast<double>(std::abs(i - peak_)) + (power_[i] - half) / (power_[i] - power_[i + direction]);
  }
  template <class Use>
  void forSideLobes(Use&& use) const {
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, peak_ - extent()); i <= std::min(size() - 1, peak_ + extent());
         ++i)
      if (i < left_null_ || i > right_null_) use(power_[i]);
  }

  std::vector<double> power_;
  std::ptrdiff_t peak_, left_null_ = 0, right_null_ = 0;
};

}  // namespace

CutMeasures measureCut(const std::vector<std::complex<double>>& cut, double step) {
  const Spectrum fine = oversample(cut, kOversampling);
  std::vector<double> power(fine.size());
  std::transform(fine.begin(), fine.end(), power.begin(), [](const auto& value) { return std::norm(value); });
  const Lobes lobes(std::move(power));
  const double fine_step = step / kOversampling;
  return {lobes.halfPowerWidth() * fine_step,
          10 * std::log10(lobes.highestSideLobe() / lobes.peakPower()),
          10 * std::log10(lobes.sideLobeEnergy() / lobes.mainLobeEnergy()),
          static_cast<double>(lobes.mainLobe()) * fine_step,
          static_cast<double>(lobes.extent()) * fine_step,
          lobes.peakPosition() * fine_step,
          lobes.peakPower(),
          lobes.complete()};
}

}  // namespace sas_motion::imaging
