// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sas_motion/filters/gaussian_sum.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"

namespace sas_motion {

/// Returns all pairs of the hypotheses of two blocks.
template <int N>
GaussianBlock<N> product(const GaussianBlock<N>& a, const GaussianBlock<N>& b) {
  GaussianBlock<N> both{a.states + b.states};
  for (const auto& g : a.hypotheses)
    for (const auto& h : b.hypotheses)
      both.hypotheses.push_back({g.deviation + h.deviation, g.covariance + h.covariance, g.log_weight + h.log_weight,
                                 g.biased | h.biased, std::max(g.scale, h.scale)});
  return both;
}

template <int N>
std::vector<double> GaussianBlock<N>::normalize() {
  double largest = -INFINITY, total = 0;
  for (const auto& h : hypotheses) largest = std::max(largest, h.log_weight);
  std::vector<double> weights;
  for (const auto& h : hypotheses) weights.push_back(std::exp(h.log_weight - largest));
  for (const double weight : weights) total += weight;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] /= total;
    hypotheses[i].log_weight -= largest + std::log(total);
  }
  return weights;
}

template <int N>
void GaussianBlock<N>::reduce(std::size_t count, double merge) {
  if (hypotheses.size() == 1) return;
  const auto weights = normalize();
  std::vector<Vector<N>> variances, logarithms;
  for (const auto& h : hypotheses) {
    variances.push_back(h.covariance.diagonal() + (Vector<N>::Ones() - states));  // 1 for states outside the block
    logarithms.push_back(variances.back().array().log());
  }
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return weights[a] != weights[b] ? weights[a] > weights[b] : a < b; });
  std::vector<bool> taken(hypotheses.size(), false);
  std::vector<Hypothesis<N>> kept;
  for (const std::size_t heaviest : order) {
    if (taken[heaviest] || kept.size() == count) continue;
    const Hypothesis<N>& center = hypotheses[heaviest];
    double total = 0;
    Vector<N> mean = Vector<N>::Zero();  // from the center's
    Matrix<N> second = Matrix<N>::Zero();
    for (const std::size_t i : order) {
      const Hypothesis<N>& h = hypotheses[i];
      if (taken[i] || h.biased != center.biased || h.scale != center.scale) continue;
      const Vector<N> off = h.deviation - center.deviation;
      const double distance = (off.array().square() / variances[heaviest].array()).sum() +
                              (logarithms[i] - logarithms[heaviest]).squaredNorm();
      if (i != heaviest && distance >= merge * states.sum()) continue;
      taken[i] = true;
      total += weights[i];
      mean += weights[i] * off;
      second += weights[i] * h.covariance;
      second.noalias() += (weights[i] * off) * off.transpose();
    }
    mean /= total;
    kept.push_back({center.deviation + mean, second / total - mean * mean.transpose(), std::log(total), center.biased,
                    center.scale});
  }
  hypotheses = std::move(kept);
}

template <int N>
void GaussianSum<N>::start() {
  if (!blocks.empty()) return;
  for (int i = 0; i < N; ++i) blocks.push_back({Vector<N>::Unit(i), {Hypothesis<N>{}}});
  couple(summary.covariance, 1, 0);
  for (auto& block : blocks) block.hypotheses.front().covariance = block.own(summary.covariance);
}

template <int N>
void GaussianSum<N>::couple(const Matrix<N>& coupling, std::size_t count, double merge) {
  const Matrix<N> either = coupling.cwiseAbs() + coupling.cwiseAbs().transpose();
  for (std::size_t a = 0; a < blocks.size(); ++a)
    for (std::size_t b = a + 1; b < blocks.size();) {
      if (blocks[a].states.dot(either * blocks[b].states) == 0) {
        ++b;
        continue;
      }
      blocks[a] = product(blocks[a], blocks[b]);
      blocks[a].reduce(count, merge);
      blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;  // an earlier block may couple with the enlarged one
    }
}

template <int N>
void GaussianSum<N>::summarize() {
  summary.covariance.setZero();
  for (auto& block : blocks) {
    const auto weights = block.normalize();
    Vector<N> mean = Vector<N>::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] * block.hypotheses[i].deviation;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      auto& h = block.hypotheses[i];
      h.deviation -= mean;
      summary.covariance += weights[i] * h.covariance;
      summary.covariance.noalias() += (weights[i] * h.deviation) * h.deviation.transpose();
    }
    summary.mean += mean;
  }
}

#define SAS_MOTION_INSTANTIATE(KIND, N)  \
  KIND template struct GaussianBlock<N>; \
  KIND template struct GaussianSum<N>;
SAS_MOTION_FOR_STATES(extern, SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion
