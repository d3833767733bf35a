// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/smoother_recorder.hpp"

#include <algorithm>

namespace sas_motion::towfish {
Audit smoothedAudit(const Measurement& z, const StateVector& x, const Model& model, const Vector<2>& weights, int iterations) {
  Audit audit = refusal(z, Verdict::Accepted, "");
  model.linearize(z, x, [&](const auto& linear) { audit.innovation.head(linear.innovation.rows()) = linear.innovation; });
  audit.weights = weights;
  audit.iterations = iterations;
  if (weights.head(audit.rows).minCoeff() < kDownWeighted) {
    audit.verdict = Verdict::DownWeighted;
    audit.reason = "residual too large for its noise";
  }
  return audit;
}

void SmootherRecorder::process(const Measurement& z, Output& output) {
  if (const char* reason = invalidity(z, config_))
    output.audits.push_back(refusal(z, Verdict::Invalid, reason));
  else
    measurements_.push_back(z);
}

void SmootherRecorder::finish(Output& output) {
  std::stable_sort(measurements_.begin(), measurements_.end(), before);
  const auto same = [](const Measurement& a, const Measurement& b) { return a.stamp == b.stamp && a.sensor == b.sensor; };
  measurements_.erase(std::unique(measurements_.begin(), measurements_.end(), same), measurements_.end());
  const auto problem = buildProblem(measurements_, config_);
  summary_ = {};
  if (!problem) {
    summary_.failure = "no position and heading to start from";
    return;
  }
  SmootherResult result = solve_(*problem);
  if (result.failure.empty()) {
    for (std::size_t k = 0; k < problem->nodes(); ++k) {
      output.estimates.push_back({problem->stamps[k], result.states[k]});
      for (std::size_t j = problem->first[k]; j < problem->first[k + 1]; ++j)
        output.audits.push_back(smoothedAudit(problem->measurements[j], result.states[k].mean, problem->model, result.weights[j], result.iterations));
    }
  }
  result.states.clear();
  result.weights.clear();
  summary_ = std::move(result);
}

}  // namespace sas_motion::towfish
