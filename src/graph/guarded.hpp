// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/linear/linearExceptions.h>
#include <gtsam/nonlinear/Marginals.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

namespace sas_motion {

/// GTSAM's messages have paragraphs; the first one says what happened.
inline std::string firstSentence(std::string text) {
  const auto begin = text.find_first_not_of(" \n");
  text = begin == std::string::npos ? "" : text.substr(begin);
  text = text.substr(0, text.find("\n\n"));
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Runs a solver by Cholesky and, where GTSAM finds the system indeterminate, by QR, which stands worse conditioning
/// (nodes a microsecond apart, long stretches without a sensor). What QR throws becomes data: the `failure` of the
/// result, which else stays as it was given.
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
