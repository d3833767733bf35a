// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/linear/linearExceptions.h>
#include <gtsam/nonlinear/LevenbergMarquardtParams.h>
#include <gtsam/nonlinear/Marginals.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

namespace sas_motion {

/// Parameters for a start near the solution, such as a filter's trajectory or a calibration's prior: the first step is
/// almost a Gauss-Newton step.
inline gtsam::LevenbergMarquardtParams levenbergMarquardt(int max_iterations, double tolerance,
                                                          gtsam::Marginals::Factorization factorization) {
  using Solvers = gtsam::NonlinearOptimizerParams;
  gtsam::LevenbergMarquardtParams params;
  params.linearSolverType =
      factorization == gtsam::Marginals::QR ? Solvers::MULTIFRONTAL_QR : Solvers::MULTIFRONTAL_CHOLESKY;
  params.maxIterations = static_cast<std::size_t>(max_iterations);
  params.relativeErrorTol = tolerance;
  params.absoluteErrorTol = 0;
  params.lambdaInitial = 1e-9;
  return params;
}

/// The first paragraph of a GTSAM message, in one line.
inline std::string firstSentence(std::string text) {
  const auto begin = text.find_first_not_of(" \n");
  text = begin == std::string::npos ? "" : text.substr(begin);
  text = text.substr(0, text.find("\n\n"));
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Runs a solver by Cholesky and, where GTSAM finds the system indeterminate, by QR, which tolerates worse conditioning
/// (nodes a microsecond apart, long stretches without a sensor). Where QR throws, the given result is returned with
/// `failure` set.
template <class Result, class Solve>
Result guarded(Result result, Solve solve) {
  try {
    try {
      result = solve(gtsam::Marginals::CHOLESKY);
    } catch (const gtsam::IndeterminantLinearSystemException&) {
      result = solve(gtsam::Marginals::QR);
    }
    if (!std::isfinite(result.cost)) result.failure = "the cost is not finite";
  } catch (const std::exception& error) {
    result.failure = firstSentence(error.what());
  }
  return result;
}

}  // namespace sas_motion
