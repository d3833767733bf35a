// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "filters/gaussian_sum_row.hpp"

#include <algorithm>
#include <cmath>

#include "filters/instantiate.hpp"

namespace sas_motion {
namespace {

constexpr double kUninformative = 1e6;  // variance of a row with an unknown bias, over the good one
constexpr double kBeyondReach = 40;     // branches whose log-weight is further below the largest are dropped

/// One Kalman update of one hypothesis with one row.
struct Branch {
  std::size_t parent;
  double log_weight, innovation, S, variance;
  bool biased;
};

/// Keeps the branches of largest weight and subtracts the largest log-weight.
void keepHeaviest(std::vector<Branch>& branches, std::size_t count) {
  const auto heavier = [](const Branch& a, const Branch& b) { return a.log_weight > b.log_weight; };
  const double best = std::min_element(branches.begin(), branches.end(), heavier)->log_weight;
  for (auto& b : branches) b.log_weight -= best;
  branches.erase(
      std::remove_if(branches.begin(), branches.end(), [](const Branch& b) { return b.log_weight < -kBeyondReach; }),
      branches.end());
  if (branches.size() <= count) return;
  std::nth_element(branches.begin(), branches.begin() + static_cast<std::ptrdiff_t>(count), branches.end(), heavier);
  branches.resize(count);
}

}  // namespace

template <int N>
double GaussianSumRow<N>::fuse(GaussianBlock<N>& block, const GaussianSumOptions& options) const {
  const double sigma = std::sqrt(r);
  std::vector<Vector<N>> Ph;
  std::vector<Branch> branches;
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

#define SAS_MOTION_INSTANTIATE(N) template struct GaussianSumRow<N>;
SAS_MOTION_FOR_STATES(SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion
