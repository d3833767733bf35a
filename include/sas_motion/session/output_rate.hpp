// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/math/stamp.hpp"

namespace sas_motion {

/// Which of many stamps are put out at a rate: the first in each period. It depends on the stamps alone.
class OutputRate {
 public:
  explicit OutputRate(double rate) : period_(stampFromSeconds(1 / rate)) {}

  bool due(Stamp stamp) {
    const Stamp tick = (stamp + period_ / 4) / period_;  // stamps that are a little early are of the period that begins
    if (last_ && tick == *last_) return false;
    last_ = tick;
    return true;
  }

 private:
  Stamp period_;
  std::optional<Stamp> last_;
};

}  // namespace sas_motion
