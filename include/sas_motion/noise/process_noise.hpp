// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "sas_motion/math/factorization.hpp"
#include "sas_motion/noise/noise_source.hpp"

namespace sas_motion {

/// Draws the whitened process noise of several states over time. Manoeuvres and contaminations that hold for an epoch
/// make the noise of all states larger together; every other law is drawn for each state on its own.
class ProcessNoise {
 public:
  static constexpr int kMostStates = 6;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostStates, 1>;  // without an allocation
  struct Draw {
    Values value;
    Values variance;  ///< what an oracle is told, over the good variance [-]
  };

  /// States take the streams from `stream` on. Throws std::invalid_argument for more than kMostStates.
  ProcessNoise(const NoiseMix& mix, int states, std::uint64_t seed, std::uint64_t stream);

  /// The noise of the step that ends at `time`; calls must have rising times.
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

/// The covariance of L w, L L^T = Q, where the elements of the whitened noise w have these variances: what an oracle
/// makes of a draw.
template <int N>
Matrix<N> toldCovariance(const Matrix<N>& Q, const Vector<N>& variance) {
  const Matrix<N> L = Q.llt().matrixL();
  Matrix<N> told = L * variance.asDiagonal() * L.transpose();
  symmetrize(told);
  return told;
}

}  // namespace sas_motion
