// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/robust/loss_moments.hpp"

#include <cmath>

namespace sas_motion {

double gaussianMeanSquaredInfluence(const Loss& loss) {
  constexpr double kStep = 1e-3, kEnd = 10;  // of the trapezoidal rule; the tail beyond is below 1e-22
  double sum = 0, mass = 0;
  for (double r = -kEnd; r <= kEnd; r += kStep) {
    const double density = std::exp(-0.5 * r * r), psi = r * loss.weight(r);
    sum += density * psi * psi;
    mass += density;
  }
  return sum / mass;
}

}  // namespace sas_motion
