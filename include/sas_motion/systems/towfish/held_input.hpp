// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::towfish {

/// The turn rate in force: the last one measured, for as long as it is used.
struct HeldInput {
  Input last;
  Stamp stamp = 0;  ///< of its measurement

  void take(const Measurement& turn_rate) {
    last.turn_rate = turn_rate.value(0);
    stamp = turn_rate.stamp;
  }
  /// The input of a step that ends at a stamp, where a turn rate is used for `hold` seconds.
  Input at(Stamp end, double hold) const { return secondsBetween(stamp, end) <= hold ? last : Input{}; }
};

}  // namespace sas_motion::towfish
