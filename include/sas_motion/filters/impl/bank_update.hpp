// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/impl/bank_moments.hpp"
#include "sas_motion/filters/impl/bank_reading.hpp"

namespace sas_motion {

/// The update of a bank by one measurement. Every hypothesis fuses the rows and is weighted by their predicted density.
/// The rates of the noise scales are learned from the average over the hypotheses.
template <int N, int M>
class BankUpdate {
 public:
  using Belief = BankBelief<N>;
  using Options = typename BankKalmanFilter<N>::Options;

  BankUpdate(const Options& options, Belief& belief, const LinearMeasurement<N, M>& z)
      : options_(options), belief_(belief), z_(z) {
    for (int row = 0; row < M; ++row) {
      place_[row] = channel(row);
      auto& learned = belief.channels[place_[row]];
      elapsed_[row] = (z.time - learned.time) / options.epoch;
      learned.time = z.time;
    }
  }

  /// Fuses the rows and returns their weights, 0 to 1.
  Vector<M> weights() {
    for (std::size_t i = 0; i < kHypotheses; ++i) hear(i);
    weigh();
    Vector<M> weights;
    for (int row = 0; row < M; ++row) weights(row) = learn(row);
    return weights;
  }

 private:
  static constexpr std::size_t kHypotheses = Belief::kHypotheses;
  static constexpr double kPriorReadings = 50;   // that the options' probabilities of the scales count as
  static constexpr double kFade = 0.5;           // factor of the stickiness for each epoch beyond the longest burst
  static constexpr double kSmallestShare = 0.1;  // of a scale's probability in the options
  static constexpr int kRowsPerSource = 8;

  std::size_t channel(int row) {
    const int key = z_.source * kRowsPerSource + row;
    for (std::size_t c = 0; c < belief_.channels.size(); ++c) {
      auto& learned = belief_.channels[c];
      if (learned.key != key && learned.key >= 0) continue;
      if (learned.key < 0) learned = {key, z_.time, kPriorReadings, options_.probabilities};
      return c;
    }
    return belief_.channels.size() - 1;  // the channels beyond the last place share it
  }

  /// The largest probability of an outlier in the other rows; that of the row itself where it is the only one.
  std::array<double, M> sharedDoubt(const BankHypothesis<N>& h) const {
    std::array<double, M> shared;
    for (int row = 0; row < M; ++row) {
      shared[row] = M == 1 ? h.channels[place_[row]].doubt : 0;
      for (int other = 0; other < M; ++other)
        if (other != row) shared[row] = std::max(shared[row], h.channels[place_[other]].doubt);
    }
    return shared;
  }

  void hear(std::size_t i) {
    auto& h = belief_.hypotheses[i];
    log_weight_[i] = std::log(h.weight);
    const auto shared = sharedDoubt(h);
    for (int row = 0; row < M; ++row) {
      const auto& c = h.channels[place_[row]];
      if (i == 1 && c.run > (shared[row] > 0.5 ? options_.burst : options_.patience)) reach(h, row);
      shares_[i][row] = fuse(h, row, shared[row], log_weight_[i]);
    }
    for (int row = 0; row < M; ++row) {
      const Vector<N> H = z_.H.row(row).transpose();
      h.channels[place_[row]].residual = z_.innovation(row) - H.dot(h.deviation);
      h.channels[place_[row]].variance = H.dot(h.covariance * H);
    }
  }

  /// Widens the hypothesis until the innovation of the row is one standard deviation.
  void reach(BankHypothesis<N>& h, int row) const {
    const Vector<N> H = z_.H.row(row).transpose();
    const double off = z_.innovation(row) - H.dot(h.deviation);
    h.covariance += widening<N>(h.covariance, H, off * off);
    h.channels[place_[row]].run = h.channels[place_[row]].doubt = 0;
  }

  /// Collapses the mixture of the row in closed form [Masreliez1975]. Returns the shares of its scales.
  BankReading::Scales fuse(BankHypothesis<N>& h, int row, double shared, double& log_weight) const {
    auto& c = h.channels[place_[row]];
    const Vector<N> H = z_.H.row(row).transpose(), PH = h.covariance * H;
    const double innovation = z_.innovation(row) - H.dot(h.deviation), v = std::max(0.0, H.dot(PH));
    const double fade = c.run > options_.burst ? std::pow(kFade, c.run - options_.burst) : 1;
    const BankReading reading(innovation, v, z_.R(row, row),
                              {options_.scales, belief_.channels[place_[row]].shares, options_.sticky, options_.repeat,
                               c.doubt * shared * fade, c.residual, std::max(0.0, v - c.variance)});
    h.deviation += PH * (innovation * reading.inverse);
    h.covariance -= (PH * (reading.inverse -
                           innovation * innovation * (reading.inverse_squared - reading.inverse * reading.inverse))) *
                    PH.transpose();
    log_weight += std::log(reading.likelihood);
    c.doubt = reading.doubt;
    c.run = reading.doubt * (std::min(elapsed_[row], 1.0) + reading.agreement * c.run);
    return reading.shares;
  }

  void weigh() {
    const double largest = *std::max_element(log_weight_.begin(), log_weight_.end());
    double sum = 0;
    for (std::size_t i = 0; i < kHypotheses; ++i)
      sum += belief_.hypotheses[i].weight = std::exp(log_weight_[i] - largest);
    for (auto& h : belief_.hypotheses) h.weight = h.weight / sum + kBankLeastWeight;
  }

  double learn(int row) {
    auto& learned = belief_.channels[place_[row]];
    learned.readings = std::min(learned.readings + 1, kBankMemory);
    double weight = 0, total = 0;
    for (std::size_t j = 0; j < BankReading::kScales; ++j) {
      double share = 0;
      for (std::size_t i = 0; i < kHypotheses; ++i) share += belief_.hypotheses[i].weight * shares_[i][row][j];
      if (j < BankReading::kNarrow) weight += share / options_.scales[j];
      learned.shares[j] = std::max(learned.shares[j] + (share - learned.shares[j]) / learned.readings,
                                   kSmallestShare * options_.probabilities[j]);
      total += learned.shares[j];
    }
    for (double& share : learned.shares) share /= total;
    return std::min(1.0, weight);
  }

  const Options& options_;
  Belief& belief_;
  const LinearMeasurement<N, M>& z_;
  std::array<std::size_t, M> place_;
  std::array<double, M> elapsed_;
  std::array<std::array<BankReading::Scales, M>, kHypotheses> shares_;
  std::array<double, kHypotheses> log_weight_;
};

}  // namespace sas_motion
