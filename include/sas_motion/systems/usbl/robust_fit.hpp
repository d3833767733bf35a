// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

struct FitOptions {
  Loss loss{LossKind::Huber};
  bool estimate_scale = true;  ///< of each channel's noise, by the median absolute residual
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< stop when the cost falls by less than this share of it [-]
};

/// Minimises the problem's cost from a starting point, with the scale as it is.
using Solver = std::function<Fit(const Problem& problem, const FitOptions& options, const Unknowns& start)>;

/// Iterated re-weighting: Levenberg-Marquardt on the weighted normal equations. The covariance is the sandwich of the
/// influence that the readings have had, A^{-1} B A^{-1} with A = sum psi' H^T R^{-1} H and B = sum psi^2 H^T R^{-1} H,
/// and the prior in both. [Huber1981, 7.6]
Fit solveIteratively(const Problem& problem, const FitOptions& options, const Unknowns& start);

/// The covariance of a solution, as above.
Matrix<kUnknowns> influenceCovariance(const Problem& problem, const Loss& loss, const Unknowns& x);
/// The loss's weight of every channel; 0 where it is absent.
std::vector<Vector<kChannels>> weightsAt(const Problem& problem, const Loss& loss, const Unknowns& x);

/// Solves with the noise's scale estimated beside: from the prior's mean, scale and solution in turns until neither
/// moves. Loss functions that redescend begin from Huber's solution. With fewer readings than unknowns a channel keeps
/// its stated noise.
Fit fit(Problem problem, const FitOptions& options, const Solver& solve = solveIteratively);

}  // namespace sas_motion::usbl
