// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/filters/impl/gaussian_sum_row.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"

namespace sas_motion {

template <int N>
GaussianSum<N> GaussianSumFilter<N>::predict(const Belief& belief, const Transition<N>& transition) const {
  const auto& terms = options_.process;
  Belief next = belief;
  next.start();
  const Matrix<N> coupling = transition.F.cwiseAbs() + transition.Q.cwiseAbs();
  next.couple(terms.size() > 1 ? Matrix<N>::Ones() : coupling, options_.hypotheses,
              options_.merge);  // all states share a scale
  if (belief.epoch_over && terms.size() > 1 && !transition.Q.isZero(0)) {
    branch(next.blocks.front());
    next.epoch_over = false;
  }
  for (auto& block : next.blocks) {
    const Matrix<N> Q = block.own(transition.Q);
    for (auto& h : block.hypotheses) {
      h.deviation = transition.F * h.deviation;
      const Matrix<N> FP = transition.F.lazyProduct(h.covariance);
      h.covariance = terms[h.scale].variance * Q + FP.lazyProduct(transition.F.transpose());
      symmetrize(h.covariance);
    }
  }
  next.summary.mean = transition.mean;
  next.summarize();
  return next;
}

template <int N>
void GaussianSumFilter<N>::branch(GaussianBlock<N>& block) const {
  const auto& terms = options_.process;
  std::vector<Hypothesis<N>> branches;
  for (const auto& h : block.hypotheses)
    for (std::size_t i = 0; i < terms.size(); ++i) {
      branches.push_back(h);
      branches.back().scale = i;
      branches.back().log_weight +=
          std::log((1 - options_.persistence) * terms[i].probability + (h.scale == i ? options_.persistence : 0));
    }
  block.hypotheses = std::move(branches);
}

template <int N>
bool GaussianSumFilter<N>::modal(std::uint64_t channel) const {
  return options_.mode.rate > 0 && (options_.mode.rows >> channel & 1) != 0;
}

/// Before its first row a mode is on with its stationary probability, since a spell can begin before the first reading.
template <int N>
void GaussianSumFilter<N>::askMode(Belief& belief, std::uint64_t channel, double time, GaussianSumRow<N>& row) const {
  const BiasMode& mode = options_.mode;
  auto& asked = belief.mode_time[mode.common ? 0 : channel];
  const double elapsed = time - asked.value_or(time), share = mode.rate * mode.length / (1 + mode.rate * mode.length);
  row.mode = mode.common ? mode.rows : std::uint64_t{1} << channel;
  row.begins = asked ? -std::expm1(-mode.rate * elapsed) : share;
  row.ends = std::min(1.0, elapsed / mode.length);
  asked = time;
}

template <int N>
template <int M>
Update<GaussianSum<N>, M> GaussianSumFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  static_assert(M <= Belief::kRows);
  auto result = examine(prior, z);
  if (result.verdict == Verdict::Invalid) return result;
  Belief& belief = result.belief;
  belief.start();
  const auto channel = [&](int row) { return static_cast<std::uint64_t>(Belief::kRows * z.source + row); };
  Vector<N> together = Vector<N>::Zero();  // states whose rows share a mode
  for (int row = 0; row < M; ++row) {
    const Vector<N> h = z.H.row(row).cwiseAbs();
    if (options_.mode.common && modal(channel(row))) together += h;
    belief.couple(h * h.transpose(), options_.hypotheses, options_.merge);
  }
  belief.couple(together * together.transpose(), options_.hypotheses, options_.merge);
  for (int row = 0; row < M; ++row) {
    GaussianSumRow<N> reading{z.H.row(row).transpose(), z.innovation(row), z.R(row, row)};
    if (modal(channel(row))) askMode(belief, channel(row), z.time, reading);
    const auto seen = [&](const GaussianBlock<N>& block) { return block.states.dot(reading.h.cwiseAbs()) != 0; };
    if (const auto block = std::find_if(belief.blocks.begin(), belief.blocks.end(), seen); block != belief.blocks.end())
      result.weights(row) = reading.fuse(*block, options_);
  }
  endEpoch(belief, z.time);
  belief.summarize();
  for (auto& block : belief.blocks) block.reduce(options_.hypotheses, options_.merge);
  symmetrize(belief.summary.covariance);
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

template <int N>
void GaussianSumFilter<N>::endEpoch(Belief& belief, double time) const {
  constexpr double kEpochTolerance = 1e-4;  // of an epoch: the resolution of stamps since 1970 in a double
  if (options_.epoch == 0 || !(time < belief.epoch_end - kEpochTolerance * options_.epoch)) {
    belief.epoch_over = true;
    belief.epoch_end = (std::floor(time / options_.epoch + kEpochTolerance) + 1) * options_.epoch;
  }
  if (!belief.epoch_over || options_.persistence > 0) return;
  for (auto& block : belief.blocks)
    for (auto& h : block.hypotheses) h.scale = 0;  // no longer used
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, GaussianSumFilter)

}  // namespace sas_motion
