// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum.hpp"

#include <algorithm>
#include <numeric>

#include "instantiate.hpp"

namespace sas_motion {

template <int N>
std::vector<double> GaussianSum<N>::normalize() {
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
void GaussianSum<N>::summarize() {
  const auto weights = normalize();
  Vector<N> mean = Vector<N>::Zero();
  Matrix<N> covariance = Matrix<N>::Zero();
  for (std::size_t i = 0; i < weights.size(); ++i) mean += weights[i] * hypotheses[i].deviation;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    auto& [deviation, P, log_weight, biased, scale] = hypotheses[i];
    deviation -= mean;
    covariance += weights[i] * P;
    covariance.noalias() += (weights[i] * deviation) * deviation.transpose();
  }
  summary.mean += mean;
  summary.covariance = covariance;
}

template <int N>
void GaussianSum<N>::reduce(std::size_t count, double merge) {
  if (hypotheses.size() == 1) return;
  const auto weights = normalize();
  std::vector<Vector<N>> variances, logarithms;
  for (const auto& h : hypotheses) {
    variances.push_back(h.covariance.diagonal());
    logarithms.push_back(variances.back().array().log());
  }
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weights[a] != weights[b] ? weights[a] > weights[b] : a < b; });
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
      const double distance = (off.array().square() / variances[heaviest].array()).sum() + (logarithms[i] - logarithms[heaviest]).squaredNorm();
      if (i != heaviest && distance >= merge) continue;
      taken[i] = true;
      total += weights[i];
      mean += weights[i] * off;
      second += weights[i] * h.covariance;
      second.noalias() += (weights[i] * off) * off.transpose();
    }
    mean /= total;
    kept.push_back({center.deviation + mean, second / total - mean * mean.transpose(), std::log(total), center.biased, center.scale});
  }
  hypotheses = std::move(kept);
}

#define SAS_MOTION_INSTANTIATE(N) template struct GaussianSum<N>;
SAS_MOTION_FOR_STATES(SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion
