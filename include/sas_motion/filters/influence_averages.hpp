// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sas_motion/math/types.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Running averages of what each row's readings have had for influence: they begin with good readings of which nothing
/// is clipped. The variance of an M-estimate is that of its influence over its mean slope, squared. [Huber1981, 3.2]
template <int M>
struct InfluenceAverages {
  Vector<M> readings = Vector<M>::Constant(kPrior);  ///< that the averages rest on
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
  static constexpr double kPrior = 20;         // readings that the assumption of good ones is worth
  static constexpr double kMemory = 300;       // readings after which old ones are forgotten
  static constexpr double kLeastSlope = 0.05;  // a mean of doubtful readings' negative ones counts as next to none
};

}  // namespace sas_motion
