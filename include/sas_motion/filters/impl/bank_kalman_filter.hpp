// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/impl/bank_moments.hpp"
#include "sas_motion/filters/impl/bank_update.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"

namespace sas_motion {

template <int N>
void BankKalmanFilter<N>::start(Belief& belief) const {
  constexpr double kPriorEpochs = 15;  // that the option's jump probability counts as: less than one jump
  belief.started = true;
  belief.jump_probability = options_.jump_probability;
  belief.epochs = kPriorEpochs;
  for (auto& h : belief.hypotheses) {
    h.weight = kBankLeastWeight;
    h.covariance = belief.summary.covariance;
  }
  belief.hypotheses[0].weight = 1;
}

template <int N>
typename BankKalmanFilter<N>::Belief BankKalmanFilter<N>::predict(const Belief& belief,
                                                                  const Transition<N>& transition) const {
  Belief prior = belief;
  if (!prior.started) {
    start(prior);
    prior.epoch_begin = NAN;  // the time of the first measurement
  }
  const Matrix<N>& F = transition.F;
  const auto moved = [&F](const Matrix<N>& P) -> Matrix<N> {
    return (F.lazyProduct(P)).eval().lazyProduct(F.transpose());
  };
  for (auto& h : prior.hypotheses) {
    h.deviation = F * h.deviation;
    h.covariance = moved(h.covariance) + transition.Q;
  }
  prior.epoch_noise = moved(prior.epoch_noise) + transition.Q;
  prior.summary = predictGaussian(belief.summary, transition);
  return prior;
}

template <int N>
void BankKalmanFilter<N>::openEpoch(Belief& belief, double time) const {
  constexpr double kFewestJumps = 0.1, kMostJumps = 5;  // of the jump probability
  constexpr int kOldest = Belief::kHypotheses - 1;
  if (std::isnan(belief.epoch_begin)) belief.epoch_begin = time;
  const double epochs = (time - belief.epoch_begin) / options_.epoch;
  if (epochs < 1 - 1e-6) return;
  auto& bank = belief.hypotheses;
  belief.epochs = std::min(belief.epochs + 1, kBankMemory);
  // the share that jumped eight openings ago and not since, slightly too small; an opening after a pause counts for its
  // epochs
  belief.jump_probability += (bank[kOldest].weight / epochs - belief.jump_probability) / belief.epochs;
  belief.jump_probability = std::clamp(belief.jump_probability, kFewestJumps * options_.jump_probability,
                                       kMostJumps * options_.jump_probability);
  const double stay = std::pow(1 - belief.jump_probability, epochs);  // a pause of the data may hold several epochs

  BankHypothesis<N> any;
  for (const auto& h : bank) absorb(any, h);
  absorb(bank[0], bank[kOldest]);
  symmetrize(bank[0].covariance);  // it is kept for ever
  for (std::size_t age = kOldest; age > 1; --age) bank[age] = bank[age - 1];
  bank[1] = any;
  bank[1].covariance += (options_.jump_scale - 1) / epochs * belief.epoch_noise;
  for (std::size_t i = 0; i < bank.size(); ++i) bank[i].weight *= i == 1 ? 1 - stay : stay;
  belief.epoch_noise.setZero();
  belief.epoch_begin = time;
}

template <int N>
template <int M>
Update<BankBelief<N>, M> BankKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  auto result = examine(prior, z);
  if (result.verdict == Verdict::Invalid) return result;
  if (!result.belief.started) {
    start(result.belief);
    result.belief.epoch_begin = z.time;
  }
  openEpoch(result.belief, z.time);
  result.weights = BankUpdate<N, M>(options_, result.belief, z).weights();
  summarize(result.belief);
  if (!result.belief.summary.mean.allFinite() || !result.belief.summary.covariance.allFinite()) {
    result.belief = prior;
    result.verdict = Verdict::Invalid;
    return result;
  }
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, BankKalmanFilter)

}  // namespace sas_motion
