// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/math/gaussian.hpp"

namespace sas_motion {

/// How a measurement was used.
enum class Verdict {
  Accepted,      ///< fused, every row with at least half its weight
  DownWeighted,  ///< fused, but a row has less than half its weight
  Rejected,      ///< not fused: the filter takes it for an outlier
  Stale,         ///< not fused: it came too late
  Invalid        ///< not fused: not finite, no usable covariance, a duplicate or a failed factorization
};

/// The result of one measurement update. After a failed factorization the belief is the prior and the verdict Invalid.
template <class Belief, int M>
struct Update {
  Belief belief;
  Vector<M> innovation = Vector<M>::Zero();  ///< z - h(x^-)
  Matrix<M> S = Matrix<M>::Zero();           ///< innovation covariance H P^- H^T + R
  double nis = 0;                            ///< innovation^T S^{-1} innovation
  Vector<M> weights = Vector<M>::Ones();     ///< per row, 0 (ignored) to 1 (full)
  int iterations = 1;
  bool converged = true;  ///< false where the iterations ended before the fixed point
  Verdict verdict = Verdict::Accepted;
};

/// Probabilities of the hypotheses of a belief; all zero where it has only one.
using HypothesisWeights = std::array<double, 9>;

template <class Belief>
HypothesisWeights hypothesisWeights(const Belief&) {
  return {};
}

constexpr double kDownWeighted = 0.5;  ///< a row below this weight counts as down-weighted

template <int M>
Verdict verdictFromWeights(const Vector<M>& weights) {
  return weights.minCoeff() < kDownWeighted ? Verdict::DownWeighted : Verdict::Accepted;
}

}  // namespace sas_motion
