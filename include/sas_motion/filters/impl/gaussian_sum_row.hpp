// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"

namespace sas_motion {

/// One row of a measurement, about the summary's mean before the first row is fused.
template <int N>
struct GaussianSumRow {
  Vector<N> h;
  double innovation, r;
  std::uint64_t mode = 0;       ///< its bit in Hypothesis::biased; 0: never biased
  double begins = 0, ends = 0;  ///< probabilities that its mode began or ended since its last evaluation

  /// Opens a branch for each term of the row's noise and keeps those of largest weight. Returns the row's weight, the
  /// expected 1 / variance.
  double fuse(GaussianBlock<N>& block, const GaussianSumOptions& options) const;
};

/// One Kalman update of one hypothesis with one row.
struct GaussianSumBranch {
  std::size_t parent;
  double log_weight, innovation, S, variance;
  bool biased;
};

/// Keeps the branches of largest weight and subtracts the largest log-weight.
void keepHeaviest(std::vector<GaussianSumBranch>& branches, std::size_t count);

template <int N>
double GaussianSumRow<N>::fuse(GaussianBlock<N>& block, const GaussianSumOptions& options) const {
  constexpr double kUninformative = 1e6;  // variance of a row with an unknown bias, over the good one
  const double sigma = std::sqrt(r);
  std::vector<Vector<N>> Ph;
  std::vector<GaussianSumBranch> branches;
  for (std::size_t i = 0; i < block.hypotheses.size(); ++i) {
    const Hypothesis<N>& parent = block.hypotheses[i];
    Ph.push_back(parent.covariance * h);
    const double v = h.dot(Ph[i]), from_parent = innovation - h.dot(parent.deviation);
    const bool was = (parent.biased & mode) != 0;
    for (const bool is : {false, true}) {
      const double change = was ? (is ? 1 - ends : ends) : is ? begins : 1 - begins;
      if (change == 0) continue;
      const auto branch = [&](double probability, double mean, double variance) {
        const double S = v + variance * r, e = from_parent - sigma * mean;
        branches.push_back({i, parent.log_weight + std::log(change * probability) - 0.5 * (std::log(S) + e * e / S), e,
                            S, variance, is});
      };
      if (is && !options.mode.bias)
        branch(1, 0, kUninformative);
      else
        for (const auto& term : options.measurement)
          branch(term.probability, term.mean + (is ? *options.mode.bias : 0), term.variance);
    }
  }
  keepHeaviest(branches, options.branches);
  std::vector<Hypothesis<N>> children;
  double total = 0, weight = 0;
  for (const auto& b : branches) {
    children.push_back(block.hypotheses[b.parent]);
    auto& child = children.back();
    child.deviation += Ph[b.parent] * (b.innovation / b.S);
    child.covariance.noalias() -= (Ph[b.parent] / b.S) * Ph[b.parent].transpose();
    child.log_weight = b.log_weight;
    child.biased = b.biased ? child.biased | mode : child.biased & ~mode;
    total += std::exp(b.log_weight);
    weight += std::exp(b.log_weight) / b.variance;
  }
  block.hypotheses = std::move(children);
  return std::min(1.0, weight / total);
}

#define SAS_MOTION_INSTANTIATE(KIND, N) KIND template struct GaussianSumRow<N>;
SAS_MOTION_FOR_STATES(extern, SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion
