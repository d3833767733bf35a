// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/NonlinearFactorGraph.h>
#include <gtsam/nonlinear/Values.h>

#include "sas_motion/systems/towfish/problem.hpp"

namespace sas_motion::towfish {

/// The smoothing problem as a factor graph: keys are the nodes' indices.
gtsam::NonlinearFactorGraph buildGraph(const SmoothingProblem& problem, const Loss& loss);
gtsam::Values initialValues(const std::vector<StateVector>& trajectory);

/// Levenberg-Marquardt on the factor graph, marginals for the covariances. Redescending losses start from the Huber
/// solution.
SmootherResult smoothBatch(const SmoothingProblem& problem, const SmootherOptions& options);

/// Graduated non-convexity with truncated least squares [Yang2020] on the same graph without losses: measurements are
/// in or out, decided at the given share of good measurements kept; prior and motion are trusted.
SmootherResult smoothGnc(const SmoothingProblem& problem, double probability);

}  // namespace sas_motion::towfish
