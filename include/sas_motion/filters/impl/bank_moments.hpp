// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/conditioning.hpp"

namespace sas_motion {

constexpr double kBankMemory = 300;         // readings or epochs in an average at most
constexpr double kBankLeastWeight = 1e-30;  // so that every hypothesis can gain weight again

/// Adds a hypothesis of positive weight to one with the moments of several.
template <int N>
void absorb(BankHypothesis<N>& sum, const BankHypothesis<N>& part) {
  sum.weight += part.weight;
  const double share = part.weight / sum.weight;
  const auto towards = [share](double& all, double one) { all += share * (one - all); };
  const Vector<N> off = part.deviation - sum.deviation;
  sum.deviation += share * off;
  sum.covariance += share * (part.covariance - sum.covariance + (1 - share) * off * off.transpose());
  for (std::size_t c = 0; c < sum.channels.size(); ++c) {
    towards(sum.channels[c].doubt, part.channels[c].doubt);
    towards(sum.channels[c].residual, part.channels[c].residual);
    towards(sum.channels[c].variance, part.channels[c].variance);
    towards(sum.channels[c].run, part.channels[c].run);
  }
}

/// Computes the bank's mean and covariance from its hypotheses and refers them to the new mean.
template <int N>
void summarize(BankBelief<N>& belief) {
  Vector<N> shift = Vector<N>::Zero();
  for (const auto& h : belief.hypotheses) shift += h.weight * h.deviation;
  belief.summary.mean += shift;
  belief.summary.covariance.setZero();
  for (auto& h : belief.hypotheses) {
    h.deviation -= shift;
    belief.summary.covariance += h.weight * (h.covariance + h.deviation * h.deviation.transpose());
  }
  symmetrize(belief.summary.covariance);
}

}  // namespace sas_motion
