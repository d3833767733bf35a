// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <tuple>

#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

class YamlSection;

struct BankKalmanOptions {
  double epoch = 1;                                                 ///< how long a jump takes to show [s]
  double jump_probability = 0.02;                                   ///< an epoch, before anything is learned
  double jump_scale = 100;                                          ///< process noise of a jump over Q [-]
  std::array<double, 4> scales{1, 9, 100, 2500};                    ///< variance over R [-]; the last two are outliers
  std::array<double, 4> probabilities{0.871, 0.079, 0.025, 0.025};  ///< of the scales, before anything is learned
  double sticky = 0.4;                                              ///< probability that an outlier follows an outlier
  double repeat = 0.4;                                              ///< and is wrong by as much
  double burst = 11;                                                ///< that long at most [epochs]
  double patience = 1.5;  ///< with agreeing readings of a row whose sisters share no doubt [epochs]
};
/// Reads all keys of a section. Throws ConfigError.
void readOptions(YamlSection yaml, BankKalmanOptions& options);

/// One way in which the last few epochs may have gone, as a Gaussian about the bank's mean, with what it thinks of each
/// channel. A channel is one row of one sensor.
template <int N>
struct BankHypothesis {
  static constexpr int kChannels = 8;
  struct Channel {
    double doubt = 0;     ///< probability that the last reading was an outlier
    double residual = 0;  ///< of the last reading, at the posterior
    double variance = 0;  ///< of that residual's prediction, H P H^T
    double run = 0;       ///< how long readings have been doubted that agree with each other [epochs]
  };
  double weight = 0;
  Vector<N> deviation = Vector<N>::Zero();
  Matrix<N> covariance = Matrix<N>::Zero();
  std::array<Channel, kChannels> channels{};
};

/// A bank's belief: its summary, the hypotheses behind it, and what it has learned of process and sensors.
template <int N>
struct BankBelief {
  static constexpr int kHypotheses = std::tuple_size_v<HypothesisWeights>;
  static constexpr int kScales = 4;
  struct Learned {
    int key = -1;  ///< sensor and row; -1 where the place is free
    double time = 0;
    double readings = 0;
    std::array<double, kScales> shares{};  ///< of the noise scales
  };
  Gaussian<N> summary;
  bool started = false;
  std::array<BankHypothesis<N>, kHypotheses> hypotheses{};  ///< 0: no jump of late; a: a jump a - 1 epochs ago
  std::array<Learned, BankHypothesis<N>::kChannels> channels{};
  Matrix<N> epoch_noise = Matrix<N>::Zero();  ///< process noise since the epoch began
  double epoch_begin = 0;                     ///< [s]
  double jump_probability = 0;                ///< an epoch
  double epochs = 0;                          ///< that it rests on
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

/// Kalman filter that keeps several explanations open: a bank of Gaussians, told apart by when the process last jumped,
/// each with Gaussian scale-mixture measurement noise [Sorenson1971; Masreliez1975].
///
/// One reading cannot tell an outlier from a manoeuvre; the next few can. Time is cut into epochs. In each a new
/// hypothesis is opened, that the process has just jumped (its noise `jump_scale` times as large); after eight epochs
/// it is folded into the hypothesis of no jump. Under each hypothesis a reading's mixture is collapsed in closed form:
/// narrow scales inform, wide ones only explain it away. Outliers of one sensor come together and stay: where another
/// row of it was just doubted too (or it has one row), the next reading is doubted sooner, and expected to be wrong by
/// as much, for up to `burst` epochs. Where readings of a row are doubted that agree with each other, and its sister
/// rows do not share the doubt (or have for longer than `burst`), the prediction is what is wrong: after `patience`
/// epochs a hypothesis is opened that reaches them. How often jumps and outliers come is learned, starting from the
/// options. R is diagonal.
template <int N>
class BankKalmanFilter {
 public:
  using Belief = BankBelief<N>;
  using Options = BankKalmanOptions;
  static constexpr Guard kGuard = Guard::None;  // the bank re-acquires by itself

  /// Throws std::invalid_argument where an option is out of its range.
  explicit BankKalmanFilter(const Options& options);

  Belief predict(const Belief& belief, const Transition<N>& transition) const;

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  void start(Belief& belief) const;
  void openEpoch(Belief& belief, double time) const;

  Options options_;
};

}  // namespace sas_motion
