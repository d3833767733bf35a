// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/LevenbergMarquardtParams.h>
#include <gtsam/nonlinear/Marginals.h>

namespace sas_motion {

/// For a start that is near the solution, as a filter's trajectory or a calibration's prior is: begins as Gauss-Newton.
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

}  // namespace sas_motion
