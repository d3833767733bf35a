// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/math/gaussian.hpp"

namespace sas_motion {

/// What became of a measurement.
enum class Verdict {
  Accepted,      ///< fused as it came
  DownWeighted,  ///< fused, a row with less than half its weight
  Rejected,      ///< left out by the filter
  Stale,         ///< too late to be fused
  Invalid        ///< not finite, no usable covariance, a duplicate or a failed factorization
};

/// The report of one measurement update. A failed factorization leaves the belief at the prior and the verdict at
/// Invalid.
template <class Belief, int M>
struct Update {
  Belief belief;
  Vector<M> innovation = Vector<M>::Zero();  ///< z - h(x^-)
  Matrix<M> S = Matrix<M>::Zero();           ///< innovation covariance H P^- H^T + R
  double nis = 0;                            ///< innovation^T S^{-1} innovation
  Vector<M> weights = Vector<M>::Ones();     ///< per row, 0 (ignored) to 1 (full)
  int iterations = 1;
  bool converged = true;  ///< false where the iteration's bound came before its fixed point
  Verdict verdict = Verdict::Accepted;
};

/// Probabilities of the explanations that a belief keeps open; all zero where it keeps one.
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
