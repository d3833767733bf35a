// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <tuple>

#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

class YamlSection;

struct BankKalmanOptions {
  double epoch = 1;                                                 ///< time in which a jump becomes visible [s]
  double jump_probability = 0.02;                                   ///< of an epoch, the initial value
  double jump_scale = 100;                                          ///< process noise of a jump over Q [-]
  std::array<double, 4> scales{1, 9, 100, 2500};                    ///< variance over R [-]; the last two are outliers
  std::array<double, 4> probabilities{0.871, 0.079, 0.025, 0.025};  ///< of the scales, the initial values
  double sticky = 0.4;                                              ///< probability that an outlier follows an outlier
  double repeat = 0.4;                                              ///< probability that it has the same error
  double burst = 11;                                                ///< longest run of such outliers [epochs]
  double patience = 1.5;  ///< longest run of agreeing outliers in one row alone [epochs]
};
/// Reads all keys of a section. Throws ConfigError.
void readOptions(YamlSection yaml, BankKalmanOptions& options);
/// Returns the options with probabilities that add up to 1. Throws std::invalid_argument where one is out of its range.
BankKalmanOptions checked(BankKalmanOptions options);

/// One history of the last epochs, as a Gaussian about the bank's mean, with the state of each channel. A channel is
/// one row of one sensor.
template <int N>
struct BankHypothesis {
  static constexpr int kChannels = 8;
  struct Channel {
    double doubt = 0;     ///< probability that the last reading was an outlier
    double residual = 0;  ///< of the last reading, at the posterior
    double variance = 0;  ///< of that residual's prediction, H P H^T
    double run = 0;       ///< how long agreeing readings have looked like outliers [epochs]
  };
  double weight = 0;
  Vector<N> deviation = Vector<N>::Zero();
  Matrix<N> covariance = Matrix<N>::Zero();
  std::array<Channel, kChannels> channels{};
};

/// A bank's belief: its hypotheses, their summary, and the learned rates of process and sensors.
template <int N>
struct BankBelief {
  static constexpr int kHypotheses = std::tuple_size_v<HypothesisWeights>;
  static constexpr int kScales = 4;
  struct Learned {
    int key = -1;  ///< sensor and row; -1: unused
    double time = 0;
    double readings = 0;
    std::array<double, kScales> shares{};  ///< of the noise scales
  };
  Gaussian<N> summary;
  bool started = false;
  std::array<BankHypothesis<N>, kHypotheses> hypotheses{};  ///< 0: no recent jump; a: a jump a - 1 epochs ago
  std::array<Learned, BankHypothesis<N>::kChannels> channels{};
  Matrix<N> epoch_noise = Matrix<N>::Zero();  ///< process noise since the epoch began
  double epoch_begin = 0;                     ///< [s]
  double jump_probability = 0;                ///< an epoch
  double epochs = 0;                          ///< number of epochs in it
};

template <int N>
const Gaussian<N>& gaussian(const BankBelief<N>& belief) {
  return belief.summary;
}

template <int N>
HypothesisWeights hypothesisWeights(const BankBelief<N>& belief) {
  HypothesisWeights weights;
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = belief.hypotheses[i].weight;
  return weights;
}

/// A bank of Kalman filters. Each assumes a different time of the last jump of the process, and Gaussian scale-mixture
/// measurement noise [Sorenson1971; Masreliez1975].
///
/// A single reading does not separate an outlier from a manoeuvre; the next few do. Time is divided into epochs. Each
/// epoch opens a hypothesis that the process has just jumped (its noise is `jump_scale` times as large). After eight
/// epochs it is merged into the hypothesis of no jump. Under each hypothesis the mixture of a reading is collapsed in
/// closed form: narrow scales update the state, wide ones do not. Outliers of one sensor come together and last. Where
/// another row of the sensor was just an outlier too (or it has one row), an outlier with the same error becomes more
/// likely, for up to `burst` epochs. Where the outliers of a row agree with each other but the other rows have none (or
/// have had them for longer than `burst`), the prediction is wrong: after `patience` epochs a hypothesis is widened to
/// include them. The rates of jumps and outliers are learned from the options' values on. R is diagonal.
template <int N>
class BankKalmanFilter {
 public:
  using Belief = BankBelief<N>;
  using Options = BankKalmanOptions;
  static constexpr Guard kGuard = Guard::None;  // the bank re-acquires by itself

  /// Throws std::invalid_argument where an option is out of its range.
  explicit BankKalmanFilter(const Options& options) : options_(checked(options)) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const;

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  void start(Belief& belief) const;
  void openEpoch(Belief& belief, double time) const;

  Options options_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/bank_kalman_filter.hpp"
