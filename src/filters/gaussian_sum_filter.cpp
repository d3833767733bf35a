// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "instantiate.hpp"
#include "sas_motion/filters/conditioning.hpp"

namespace sas_motion {
namespace {

constexpr double kUninformative = 1e6;      // variance of a row with an unknown bias, over the good one
constexpr double kBeyondReach = 40;       // a branch whose log-weight is so far below the best's is not followed
constexpr double kEpochTolerance = 1e-4;  // of an epoch: stamps since 1970 are no finer in a double

void requireTerms(const char* what, std::vector<NoiseTerm>& terms) {
  double total = 0;
  for (const auto& term : terms) {
    if (!(term.variance > 0) || !(term.probability >= 0) || !std::isfinite(term.mean))
      throw std::invalid_argument(fmt::format("{}: a term needs a positive variance and a probability of at least 0", what));
    total += term.probability;
  }
  if (!(total > 0)) throw std::invalid_argument(fmt::format("{}: at least one probability must be positive", what));
  for (auto& term : terms) term.probability /= total;
  terms.erase(std::remove_if(terms.begin(), terms.end(), [](const NoiseTerm& term) { return term.probability == 0; }), terms.end());
}

/// A Kalman update that one hypothesis could make of one row.
struct Branch {
  std::size_t parent;
  double log_weight, innovation, S, variance;
  bool biased;
};

}  // namespace

/// One row of a measurement, about the summary's mean before any row was fused.
template <int N>
struct GaussianSumFilter<N>::Row {
  Vector<N> h;
  double innovation, r, time;
  std::uint32_t channel;
};

template <int N>
GaussianSumFilter<N>::GaussianSumFilter(const GaussianSumOptions& options) : options_(options) {
  requireTerms("measurement", options_.measurement);
  requireTerms("process", options_.process);
  if (!(options.epoch >= 0)) throw std::invalid_argument(fmt::format("epoch: {} must be at least 0", options.epoch));
  if (!(options.persistence >= 0 && options.persistence < 1))
    throw std::invalid_argument(fmt::format("persistence: {} must lie in [0, 1)", options.persistence));
  if (!(options.mode.rate >= 0) || !(options.mode.length > 0)) throw std::invalid_argument("mode: rate must be at least 0 and length positive");
  if (options.hypotheses < 1 || options.branches < options.hypotheses)
    throw std::invalid_argument("hypotheses must be at least 1, and branches at least as many");
}

template <int N>
GaussianSum<N> GaussianSumFilter<N>::predict(const Belief& belief, const Transition<N>& transition) const {
  Belief next = belief;
  if (next.hypotheses.empty()) next.hypotheses.push_back({Vector<N>::Zero(), belief.summary.covariance, 0, 0, 0});
  const auto& terms = options_.process;
  if (belief.epoch_over && terms.size() > 1 && !transition.Q.isZero(0)) {
    std::vector<Hypothesis<N>> branches;
    for (const auto& h : next.hypotheses)
      for (std::size_t i = 0; i < terms.size(); ++i) {
        branches.push_back(h);
        branches.back().scale = i;
        branches.back().log_weight += std::log((1 - options_.persistence) * terms[i].probability + (h.scale == i ? options_.persistence : 0));
      }
    next.hypotheses = std::move(branches);
    next.epoch_over = false;
  }
  for (auto& h : next.hypotheses) {
    h.deviation = transition.F * h.deviation;
    const Matrix<N> FP = transition.F.lazyProduct(h.covariance);
    h.covariance = terms[h.scale].variance * transition.Q + FP.lazyProduct(transition.F.transpose());
    symmetrize(h.covariance);
  }
  next.summary.mean = transition.mean;
  next.summarize();
  return next;
}

/// Probabilities that a row's mode begins, and that it ends, since it was last asked for.
template <int N>
std::array<double, 2> GaussianSumFilter<N>::modeSwitch(Belief& belief, const Row& row) const {
  double& asked = belief.mode_time[options_.mode.common ? 0 : row.channel];
  const double elapsed = asked == 0 ? 0 : row.time - asked;
  asked = row.time;
  return {-std::expm1(-options_.mode.rate * elapsed), std::min(1.0, elapsed / options_.mode.length)};
}

/// Branches on all that one row's noise can be; the weight is the expected 1 / variance.
template <int N>
double GaussianSumFilter<N>::fuse(Belief& belief, const Row& row) const {
  const bool modal = options_.mode.rate > 0 && (options_.mode.rows >> row.channel & 1) != 0;
  const std::uint32_t bit = options_.mode.common ? options_.mode.rows : 1u << row.channel;
  const auto [begins, ends] = modal ? modeSwitch(belief, row) : std::array<double, 2>{};
  const auto& parents = belief.hypotheses;
  std::vector<Vector<N>> Ph(parents.size());
  std::vector<Branch> branches;
  double best = -INFINITY;
  const auto branch = [&](std::size_t parent, double log_weight, double innovation, double variance, double v, bool biased) {
    const double S = v + variance * row.r;
    branches.push_back({parent, log_weight - 0.5 * (std::log(S) + innovation * innovation / S), innovation, S, variance, biased});
    best = std::max(best, branches.back().log_weight);
  };
  for (std::size_t i = 0; i < parents.size(); ++i) {
    Ph[i] = parents[i].covariance * row.h;
    const double v = row.h.dot(Ph[i]), innovation = row.innovation - row.h.dot(parents[i].deviation), sigma = std::sqrt(row.r);
    const bool was = modal && (parents[i].biased & bit) != 0;
    for (const bool is : {false, true}) {
      const double change = was ? (is ? 1 - ends : ends) : is ? begins : 1 - begins;
      if (change == 0) continue;
      const double log_weight = parents[i].log_weight + std::log(change);
      if (is && !options_.mode.bias) {
        branch(i, log_weight, innovation, kUninformative, v, is);
        continue;
      }
      for (const auto& term : options_.measurement)
        branch(i, log_weight + std::log(term.probability), innovation - sigma * (term.mean + (is ? *options_.mode.bias : 0)), term.variance, v, is);
    }
  }
  const auto heavier = [](const Branch& a, const Branch& b) { return a.log_weight > b.log_weight; };
  branches.erase(std::remove_if(branches.begin(), branches.end(), [&](const Branch& b) { return b.log_weight < best - kBeyondReach; }), branches.end());
  if (branches.size() > options_.branches) {
    std::nth_element(branches.begin(), branches.begin() + static_cast<std::ptrdiff_t>(options_.branches), branches.end(), heavier);
    branches.resize(options_.branches);
  }
  std::vector<Hypothesis<N>> children;
  double total = 0, weight = 0;
  for (const auto& b : branches) {
    children.push_back(parents[b.parent]);
    auto& child = children.back();
    child.deviation += Ph[b.parent] * (b.innovation / b.S);
    child.covariance.noalias() -= (Ph[b.parent] / b.S) * Ph[b.parent].transpose();
    child.log_weight = b.log_weight - best;
    if (modal) child.biased = b.biased ? child.biased | bit : child.biased & ~bit;
    total += std::exp(child.log_weight);
    weight += std::exp(child.log_weight) / b.variance;
  }
  belief.hypotheses = std::move(children);
  return std::min(1.0, weight / total);
}

template <int N>
template <int M>
Update<GaussianSum<N>, M> GaussianSumFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  static_assert(M <= Belief::kRows);
  auto result = examine(prior, z);
  if (result.verdict == Verdict::Invalid) return result;
  Belief& belief = result.belief;
  if (belief.hypotheses.empty()) belief.hypotheses.push_back({Vector<N>::Zero(), belief.summary.covariance, 0, 0, 0});
  for (int row = 0; row < M; ++row)
    result.weights(row) =
        fuse(belief, {z.H.row(row).transpose(), z.innovation(row), z.R(row, row), z.time, static_cast<std::uint32_t>(Belief::kRows * z.source + row)});
  if (options_.epoch == 0 || !(z.time < belief.epoch_end - kEpochTolerance * options_.epoch)) {
    belief.epoch_over = true;
    belief.epoch_end = (std::floor(z.time / options_.epoch + kEpochTolerance) + 1) * options_.epoch;
  }
  if (belief.epoch_over && options_.persistence == 0)
    for (auto& h : belief.hypotheses) h.scale = 0;  // of no more consequence
  belief.summarize();
  belief.reduce(options_.hypotheses, options_.merge);
  symmetrize(belief.summary.covariance);
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(GaussianSumFilter)

}  // namespace sas_motion
