// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "sas_motion/math/factorization.hpp"
#include "sas_motion/math/random.hpp"
#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// One draw of noise in units of the good standard deviation.
struct NoiseSample {
  double value = 0;
  double variance = 1;   ///< variance of this draw for oracles, over the good variance [-]
  bool outlier = false;  ///< the label: a bad draw, or a Student's t more than three times too wide
  bool missing = false;  ///< there is no measurement
  bool frozen = false;   ///< the measurement is the last one again
  double quantum = 0;    ///< the measurement is rounded to multiples of this; 0: not rounded
};

constexpr double kNoInformation =
    1e6;  ///< variance of a reading without information, for oracles, over the good one [-]

/// Spells that begin at random, `rate` a second, and last `length` seconds; they do not overlap.
class Spells {
 public:
  /// Whether a spell is on. `dice` is a uniform draw and `elapsed` the time since the last call [s].
  bool on(const NoiseLaw& law, double time, double elapsed, double dice);

 private:
  double until_ = -1;
  bool on_ = false;
};

/// Draws one sensor channel's noise; the times of calls must rise.
class NoiseSource {
 public:
  /// Rows of one sensor with the same `spell_stream` have their bursts, freezes and drop-outs together.
  NoiseSource(const NoiseMix& mix, std::uint64_t seed, std::uint64_t stream,
              std::optional<std::uint64_t> spell_stream = {});
  NoiseSample draw(double time);

 private:
  /// One law with its state and its own random numbers.
  struct Part {
    NoiseLaw law;
    Random random, spell_random;
    Spells spells;
    double gauss_markov;

    void apply(NoiseSample& sample, double time, double elapsed, double dice);
  };

  Random random_;
  std::vector<Part> parts_;
  double last_time_ = 0;
};

/// The standard deviation of a varying law at a time, over the good one.
double varyingSigma(const NoiseLaw& law, double time);

/// Draws the whitened process noise of several states. Manoeuvres and contaminations with an epoch enlarge the noise of
/// all states together; every other law is drawn for each state on its own.
class ProcessNoise {
 public:
  static constexpr int kMostStates = 6;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostStates, 1>;  // without an allocation
  struct Draw {
    Values value;
    Values variance;  ///< for oracles, over the good variance [-]
  };

  /// State i takes the stream `stream` + i. Throws std::invalid_argument for more than kMostStates.
  ProcessNoise(const NoiseMix& mix, int states, std::uint64_t seed, std::uint64_t stream);

  /// The noise of the step that ends at `time`; the times of calls must rise.
  Draw draw(double time);

 private:
  /// A law that acts on all states.
  struct Common {
    NoiseLaw law;
    Random random;
    Spells spells;
    long epoch;
    bool large;

    bool on(double time, double elapsed);
  };

  std::vector<NoiseSource> states_;
  std::vector<Common> common_;
  double last_time_ = 0;
};

/// The covariance of L w, where L L^T = Q and the elements of w have these variances. Oracles use it.
template <int N>
Matrix<N> covarianceWith(const Matrix<N>& Q, const Vector<N>& variance) {
  const Matrix<N> L = Q.llt().matrixL();
  Matrix<N> scaled = L * variance.asDiagonal() * L.transpose();
  symmetrize(scaled);
  return scaled;
}

}  // namespace sas_motion
