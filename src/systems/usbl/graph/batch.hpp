// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/NonlinearFactorGraph.h>

#include "sas_motion/systems/usbl/fitter.hpp"

namespace sas_motion::usbl {

/// A calibration as a factor graph: a rotation and a lever arm, and the transponder and the range's scale where they
/// are estimated. What is known stays as in `known`.
gtsam::NonlinearFactorGraph buildGraph(const Problem& problem, const Loss& loss, const Unknowns& known);

/// Minimises the problem's cost by Levenberg-Marquardt on the factor graph: a Solver, the twin of solveIteratively,
/// with the same covariance.
Fit solveFactorGraph(const Problem& problem, const FitOptions& options, const Unknowns& start);

/// Graduated non-convexity with truncated least squares [Yang2020] on the same graph without a loss: readings are in or
/// out, decided at the given share of good readings kept; the prior is trusted. The covariance is the marginals' of
/// what is in.
Fit solveGnc(const Problem& problem, double probability, const Unknowns& start);

/// The marginal covariance of the unknowns at x, from the graph linearised there; its rows of what is known are 0.
/// Throws what GTSAM throws.
Matrix<kUnknowns> marginalCovariance(const gtsam::NonlinearFactorGraph& graph, const Prior& prior, const Unknowns& x);

/// batch: the robust fit by the factor graph; gnc: its scale, then solveGnc. Empty for another name.
Fitter makeFitter(const std::string& name);

}  // namespace sas_motion::usbl
