// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/bank_kalman_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "bank_reading.hpp"
#include "instantiate.hpp"
#include "sas_motion/filters/conditioning.hpp"

namespace sas_motion {
namespace {

constexpr double kFade = 0.5;                         // an epoch: stickiness beyond the longest burst
constexpr double kPriorCount = 50;                    // readings or epochs that the options' probabilities are worth
constexpr double kMemory = 300;                       // readings or epochs after which old ones are forgotten
constexpr double kSmallestShare = 0.1;                // of a scale's own probability: nothing is ever ruled out
constexpr double kFewestJumps = 0.1, kMostJumps = 5;  // of the jump probability
constexpr double kLeastWeight = 1e-30;                // a hypothesis can always come back
constexpr int kRowsPerSource = 8;

void require(bool holds, const char* key, double value, const char* must) {
  if (!holds) throw std::invalid_argument(fmt::format("{} is {} but must be {}", key, value, must));
}

/// Adds `part`, weighted, to a moment-matched sum whose mean is known.
template <int N>
void addTo(BankHypothesis<N>& sum, const BankHypothesis<N>& part, double share) {
  const Vector<N> e = part.deviation - sum.deviation;
  sum.covariance += share * (part.covariance + e * e.transpose());
  for (std::size_t c = 0; c < sum.channels.size(); ++c) {
    sum.channels[c].doubt += share * part.channels[c].doubt;
    sum.channels[c].residual += share * part.channels[c].residual;
    sum.channels[c].variance += share * part.channels[c].variance;
    sum.channels[c].run += share * part.channels[c].run;
  }
}

/// The Gaussian with the moments of the hypotheses that `chosen` says yes to.
template <int N, class Chosen>
BankHypothesis<N> merged(const BankBelief<N>& belief, Chosen&& chosen) {
  BankHypothesis<N> sum;
  for (int i = 0; i < BankBelief<N>::kHypotheses; ++i)
    if (chosen(i)) sum.weight += belief.hypotheses[static_cast<std::size_t>(i)].weight;
  for (int i = 0; i < BankBelief<N>::kHypotheses; ++i)
    if (const auto& part = belief.hypotheses[static_cast<std::size_t>(i)]; chosen(i)) sum.deviation += part.weight / sum.weight * part.deviation;
  for (int i = 0; i < BankBelief<N>::kHypotheses; ++i)
    if (const auto& part = belief.hypotheses[static_cast<std::size_t>(i)]; chosen(i)) addTo(sum, part, part.weight / sum.weight);
  return sum;
}

/// Moves the bank's mean to the mean of its hypotheses and sums them up.
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

}  // namespace

template <int N>
BankKalmanFilter<N>::BankKalmanFilter(const Options& options) : options_(options) {
  require(options.epoch > 0, "epoch", options.epoch, "positive");
  require(options.jump_probability > 0 && options.jump_probability < 0.2, "jump_probability", options.jump_probability, "between 0 and 0.2");
  require(options.jump_scale >= 1, "jump_scale", options.jump_scale, "at least 1");
  require(options.sticky >= 0 && options.sticky < 1, "sticky", options.sticky, "at least 0 and below 1");
  require(options.repeat >= 0 && options.repeat <= 1, "repeat", options.repeat, "between 0 and 1");
  require(options.burst >= 0, "burst", options.burst, "at least 0");
  require(options.patience > 0, "patience", options.patience, "positive");
  for (const double scale : options.scales) require(scale > 0, "scales", scale, "positive");
  const double sum = std::accumulate(options.probabilities.begin(), options.probabilities.end(), 0.0);
  for (double& p : options_.probabilities) {
    require(p > 0, "probabilities", p, "positive");
    p /= sum;
  }
}

template <int N>
void BankKalmanFilter<N>::start(Belief& belief) const {
  belief.started = true;
  belief.jump_probability = options_.jump_probability;
  belief.epochs = kPriorCount;
  for (auto& h : belief.hypotheses) {
    h.weight = kLeastWeight;
    h.covariance = belief.summary.covariance;
  }
  belief.hypotheses[0].weight = 1;
}

template <int N>
typename BankKalmanFilter<N>::Belief BankKalmanFilter<N>::predict(const Belief& belief, const Transition<N>& transition) const {
  Belief prior = belief;
  if (!prior.started) {
    start(prior);
    prior.epoch_begin = NAN;  // the time of the first measurement
  }
  const Matrix<N>& F = transition.F;
  const auto moved = [&F](const Matrix<N>& P) -> Matrix<N> { return (F.lazyProduct(P)).eval().lazyProduct(F.transpose()); };
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
  constexpr int kOldest = Belief::kHypotheses - 1;
  if (std::isnan(belief.epoch_begin)) belief.epoch_begin = time;
  const double epochs = (time - belief.epoch_begin) / options_.epoch;
  if (epochs < 1 - 1e-6) return;
  auto& bank = belief.hypotheses;
  belief.epochs = std::min(belief.epochs + 1, kMemory);
  // what jumped eight openings ago and not since: a little too few; an opening after a pause counts for its epochs
  belief.jump_probability += (bank[kOldest].weight / epochs - belief.jump_probability) / belief.epochs;
  belief.jump_probability = std::clamp(belief.jump_probability, kFewestJumps * options_.jump_probability, kMostJumps * options_.jump_probability);
  const double stay = std::pow(1 - belief.jump_probability, epochs);  // a pause of the data may hold several epochs

  const auto none = merged(belief, [](int i) { return i == 0 || i == kOldest; });
  const auto all = merged(belief, [](int) { return true; });
  for (std::size_t age = kOldest; age > 1; --age) bank[age] = bank[age - 1];
  bank[0] = none;
  symmetrize(bank[0].covariance);  // it lives for ever
  bank[1] = all;
  bank[1].covariance += (options_.jump_scale - 1) / epochs * belief.epoch_noise;
  for (std::size_t i = 0; i < bank.size(); ++i) bank[i].weight *= i == 1 ? 1 - stay : stay;
  belief.epoch_noise.setZero();
  belief.epoch_begin = time;
}

template <int N>
std::size_t BankKalmanFilter<N>::channel(Belief& belief, int key, double time) const {
  for (std::size_t c = 0; c < belief.channels.size(); ++c) {
    auto& learned = belief.channels[c];
    if (learned.key != key && learned.key >= 0) continue;
    if (learned.key < 0) learned = {key, time, kPriorCount, options_.probabilities};
    return c;
  }
  return belief.channels.size() - 1;  // more channels than places: the last ones share one
}

template <int N>
template <int M>
void BankKalmanFilter<N>::judge(Belief& belief, const LinearMeasurement<N, M>& z, Vector<M>& weights) const {
  using Learned = typename Belief::Learned;
  std::array<std::size_t, M> place;
  std::array<double, M> elapsed;
  for (int row = 0; row < M; ++row) {
    place[row] = channel(belief, z.source * kRowsPerSource + row, z.time);
    Learned& learned = belief.channels[place[row]];
    elapsed[row] = (z.time - learned.time) / options_.epoch;
    learned.time = z.time;
  }
  std::array<std::array<BankReading::Scales, M>, Belief::kHypotheses> shares;
  std::array<double, Belief::kHypotheses> log_weight;
  for (std::size_t i = 0; i < belief.hypotheses.size(); ++i) {
    auto& h = belief.hypotheses[i];
    log_weight[i] = std::log(h.weight);
    std::array<double, M> shared;  // doubt in the sister rows
    for (int row = 0; row < M; ++row) {
      shared[row] = M == 1 ? h.channels[place[row]].doubt : 0;
      for (int other = 0; other < M; ++other)
        if (other != row) shared[row] = std::max(shared[row], h.channels[place[other]].doubt);
    }
    for (int row = 0; row < M; ++row) {
      auto& c = h.channels[place[row]];
      const Vector<N> H = z.H.row(row).transpose();
      const double reach = z.innovation(row) - H.dot(h.deviation);
      if (i == 1 && c.run > (shared[row] > 0.5 ? options_.burst : options_.patience)) {
        h.covariance += widening<N>(h.covariance, H, reach * reach);
        c.run = c.doubt = 0;
      }
      const Vector<N> PH = h.covariance * H;
      const double v = std::max(0.0, H.dot(PH)), fade = c.run > options_.burst ? std::pow(kFade, c.run - options_.burst) : 1;
      const BankReading reading(reach, v, z.R(row, row),
                                {options_.scales, belief.channels[place[row]].shares, options_.sticky, options_.repeat, c.doubt * shared[row] * fade,
                                 c.residual, std::max(0.0, v - c.variance)});
      h.deviation += PH * (reach * reading.inverse);
      h.covariance -= (PH * (reading.inverse - reach * reach * (reading.inverse_squared - reading.inverse * reading.inverse))) * PH.transpose();
      log_weight[i] += std::log(reading.likelihood);
      c.doubt = reading.doubt;
      c.run = reading.doubt * (std::min(elapsed[row], 1.0) + reading.agreement * c.run);
      shares[i][static_cast<std::size_t>(row)] = reading.shares;
    }
    for (int row = 0; row < M; ++row) {
      const Vector<N> H = z.H.row(row).transpose();
      h.channels[place[row]].residual = z.innovation(row) - H.dot(h.deviation);
      h.channels[place[row]].variance = H.dot(h.covariance * H);
    }
  }
  const double largest = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0;
  for (std::size_t i = 0; i < log_weight.size(); ++i) sum += belief.hypotheses[i].weight = std::exp(log_weight[i] - largest);
  for (auto& h : belief.hypotheses) h.weight = h.weight / sum + kLeastWeight;

  for (int row = 0; row < M; ++row) {
    Learned& learned = belief.channels[place[row]];
    learned.readings = std::min(learned.readings + 1, kMemory);
    weights(row) = 0;
    double total = 0;
    for (std::size_t j = 0; j < BankReading::kScales; ++j) {
      double share = 0;
      for (std::size_t i = 0; i < shares.size(); ++i) share += belief.hypotheses[i].weight * shares[i][static_cast<std::size_t>(row)][j];
      if (j < BankReading::kNarrow) weights(row) += share / options_.scales[j];
      learned.shares[j] = std::max(learned.shares[j] + (share - learned.shares[j]) / learned.readings, kSmallestShare * options_.probabilities[j]);
      total += learned.shares[j];
    }
    for (double& share : learned.shares) share /= total;
    weights(row) = std::min(1.0, weights(row));
  }
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
  judge(result.belief, z, result.weights);
  summarize(result.belief);
  if (!result.belief.summary.mean.allFinite() || !result.belief.summary.covariance.allFinite()) {
    result.belief = prior;
    result.verdict = Verdict::Invalid;
    return result;
  }
  result.verdict = verdictFromWeights(result.weights);
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(BankKalmanFilter)

}  // namespace sas_motion
