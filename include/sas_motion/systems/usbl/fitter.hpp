// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

struct FitOptions {
  Loss loss{LossKind::Huber};
  bool estimate_scale = true;  ///< of each channel's noise, by the median absolute residual
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< relative fall of the cost at which iterations stop [-]
};

/// Minimises the problem's cost from a starting point, without a change of the scale.
using Solver = std::function<Fit(const Problem& problem, const FitOptions& options, const Unknowns& start)>;

/// Iterated re-weighting: Levenberg-Marquardt on the weighted normal equations. The covariance is that of the readings'
/// influence, A^{-1} B A^{-1} with A = sum psi' H^T R^{-1} H and B = sum psi^2 H^T R^{-1} H, and the prior in both.
/// [Huber1981, 7.6]
Fit solveIteratively(const Problem& problem, const FitOptions& options, const Unknowns& start);

/// The covariance of a solution, as above.
Matrix<kUnknowns> influenceCovariance(const Problem& problem, const Loss& loss, const Unknowns& x);
/// The loss's weight of every channel; 0 where it is absent.
std::vector<Vector<kChannels>> weightsAt(const Problem& problem, const Loss& loss, const Unknowns& x);

/// Solves from the prior's mean and estimates the noise's scale, in turns until neither moves. Redescending losses
/// begin from Huber's solution. A channel with too few readings keeps its stated noise.
Fit fit(Problem problem, const FitOptions& options, const Solver& solve = solveIteratively);

/// Calibrates by all pings at once, from the prior's mean, with the noise's scale estimated.
using Fitter = std::function<Fit(const Problem& problem, const FitOptions& options)>;

/// Makes the fitter of a name; empty for an unknown one.
using FitterFactory = std::function<Fitter(const std::string& name)>;

/// The fitter batch without a factor graph; empty for another name.
inline Fitter nativeFitter(const std::string& name) {
  if (name != "batch") return {};
  return [](const Problem& problem, const FitOptions& options) { return fit(problem, options); };
}

}  // namespace sas_motion::usbl
