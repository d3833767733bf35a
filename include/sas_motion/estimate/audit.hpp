// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "sas_motion/filters/update.hpp"
#include "sas_motion/math/stamp.hpp"

namespace sas_motion {

constexpr int kMostRows = 3;  ///< of one measurement

/// What an estimator of any system did with one measurement; the first `rows` rows count.
struct Audit {
  Stamp stamp = 0;
  std::string_view sensor;  ///< its name: a literal, or text that outlives the audit
  int rows = 0;
  Verdict verdict = Verdict::Accepted;
  Vector<kMostRows> innovation = Vector<kMostRows>::Zero();  ///< z - h(x), before the update
  Matrix<kMostRows> S = Matrix<kMostRows>::Zero();           ///< its covariance, before any weighting; zeros: not known
  double nis = 0;
  Vector<kMostRows> weights = Vector<kMostRows>::Ones();
  int iterations = 0;
  std::string_view reason = "";    ///< plain words, a literal; empty where there is nothing to say
  double effective_size = 0;       ///< of a filter's particles, where it has several
  HypothesisWeights hypotheses{};  ///< of a filter that keeps several
};

/// The audit of a filter's update.
template <class Belief, int M>
Audit auditOf(Stamp stamp, std::string_view sensor, const Update<Belief, M>& update) {
  static_assert(M <= kMostRows, "a measurement of more rows than an audit has");
  Audit audit{stamp, sensor, M, update.verdict};
  audit.innovation.template head<M>() = update.innovation;
  audit.S.template topLeftCorner<M, M>() = update.S;
  audit.nis = update.nis;
  audit.weights.template head<M>() = update.weights;
  audit.iterations = update.iterations;
  audit.hypotheses = hypothesisWeights(update.belief);
  if (update.verdict == Verdict::Invalid) audit.reason = "numerically singular";
  if (update.verdict == Verdict::Rejected) audit.reason = "outside the gate";
  if (update.verdict == Verdict::DownWeighted) audit.reason = "residual too large for its noise";
  return audit;
}

/// The audit of a measurement that was not fused.
inline Audit refusal(Stamp stamp, std::string_view sensor, int rows, Verdict verdict, std::string_view reason) {
  Audit audit{stamp, sensor, rows, verdict};
  audit.reason = reason;
  if (verdict != Verdict::Accepted) audit.weights.setZero();
  return audit;
}

}  // namespace sas_motion
