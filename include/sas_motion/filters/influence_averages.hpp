// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sas_motion/math/types.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Running averages of the influence of each row's readings. They start at the values of good, unclipped readings. The
/// variance of an M-estimate is that of its influence over its mean slope, squared. [Huber1981, 3.2]
template <int M>
struct InfluenceAverages {
  Vector<M> readings = Vector<M>::Constant(kPrior);  ///< number of readings in the averages
  Vector<M> square = Vector<M>::Ones();              ///< psi^2
  Vector<M> slope = Vector<M>::Ones();               ///< psi'
  Vector<M> weight = Vector<M>::Ones();              ///< psi(r) / r

  void learn(int row, const Influence& influence) {
    readings(row) = std::min(readings(row) + 1, kMemory);
    const auto average = [&](double& sum, double value) { sum += (value - sum) / readings(row); };
    average(square(row), influence.psi * influence.psi);
    average(slope(row), influence.slope);
    slope(row) = std::max(slope(row), kLeastSlope);
    average(weight(row), influence.weight);
  }

 private:
  static constexpr double kPrior = 20;         // readings that the initial values count as
  static constexpr double kMemory = 300;       // readings after which old ones are forgotten
  static constexpr double kLeastSlope = 0.05;  // a mean slope can be negative where most readings are outliers
};

}  // namespace sas_motion
