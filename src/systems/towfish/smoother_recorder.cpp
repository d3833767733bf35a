// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/smoother_recorder.hpp"

#include <algorithm>

namespace sas_motion::towfish {
namespace {

void refuse(const std::vector<Measurement>& measurements, Verdict verdict, const char* reason, Output& output) {
  for (const auto& z : measurements) output.audits.push_back(refusal(z, verdict, reason));
}

}  // namespace

Audit smoothedAudit(const Measurement& z, const StateVector& x, const Model& model, const Vector<2>& weights,
                    int iterations) {
  Audit audit = refusal(z, Verdict::Accepted, "");
  model.linearize(z, x,
                  [&](const auto& linear) { audit.innovation.head(linear.innovation.rows()) = linear.innovation; });
  audit.weights.head<2>() = weights;
  audit.iterations = iterations;
  if (weights.head(audit.rows).minCoeff() < kDownWeighted) {
    audit.verdict = Verdict::DownWeighted;
    audit.reason = "residual too large for its noise";
  }
  return audit;
}

void SmootherRecorder::process(const Measurement& z, Output& output) {
  const auto place = std::lower_bound(measurements_.begin(), measurements_.end(), z, before);
  if (place != measurements_.end() && !before(z, *place)) {  // it was there before the last finish()
    output.audits.push_back(refusal(z, Verdict::Invalid, "duplicate stamp"));
    return;
  }
  measurements_.insert(place, z);
  unsolved_ = true;
}

void SmootherRecorder::finish(Output& output) {
  if (!unsolved_) {
    summary_.failure = "nothing new since the last solution";
    return;
  }
  unsolved_ = false;
  const auto problem = buildProblem(measurements_, config_);
  summary_ = {};
  if (!problem) {
    summary_.failure = "no position and heading to start from";
    return refuse(measurements_, Verdict::Stale, "before the first position and heading", output);
  }
  const auto start = std::find_if(measurements_.begin(), measurements_.end(),
                                  [&](const Measurement& z) { return z.stamp >= problem->stamps.front(); });
  refuse({measurements_.begin(), start}, Verdict::Stale, "before the first position and heading", output);
  SmootherResult result = solve_(*problem);
  if (!result.failure.empty())
    refuse({start, measurements_.end()}, Verdict::Invalid, "the smoother found no solution", output);
  for (std::size_t k = 0; result.failure.empty() && k < problem->nodes(); ++k) {
    output.solutions.push_back({problem->stamps[k], result.states[k]});
    for (std::size_t j = problem->first[k]; j < problem->first[k + 1]; ++j)
      output.audits.push_back(smoothedAudit(problem->measurements[j], result.states[k].mean, problem->model,
                                            result.weights[j], result.iterations));
  }
  result.states.clear();
  result.weights.clear();
  summary_ = std::move(result);
}

}  // namespace sas_motion::towfish
