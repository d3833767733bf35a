// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// The loss of the smoothers and their iterations.
struct SmootherOptions {
  Loss loss{LossKind::Huber};
  int max_iterations = 100;
  double tolerance = 1e-9;  ///< stop when the cost falls by less than this share of it [-]
};

struct FixedLagOptions {
  Loss loss{LossKind::Huber};
  double lag = 10;              ///< the window's length [s]
  double solve_interval = 0.5;  ///< stamps between two solutions [s]
  double reorder = 2;           ///< measurements wait this long for older ones [s]
};

}  // namespace sas_motion
