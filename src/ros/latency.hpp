// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace sas_motion::ros_side {

/// The last few thousand latencies, and their quantiles. Adding one does not allocate.
class LatencyMeter {
 public:
  void add(double seconds) { ring_[count_++ % ring_.size()] = seconds; }
  std::size_t count() const { return count_; }
  /// The `fraction` quantile [s]; 0 before the first.
  double quantile(double fraction) const {
    const std::size_t filled = std::min(count_, ring_.size());
    if (filled == 0) return 0;
    auto sorted = ring_;
    const auto place = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(filled - 1));
    std::nth_element(sorted.begin(), sorted.begin() + place, sorted.begin() + static_cast<std::ptrdiff_t>(filled));
    return sorted[static_cast<std::size_t>(place)];
  }

 private:
  std::array<double, 4096> ring_{};
  std::size_t count_ = 0;
};

}  // namespace sas_motion::ros_side
