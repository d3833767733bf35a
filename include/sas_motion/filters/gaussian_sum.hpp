// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/gaussian.hpp"

namespace sas_motion {

/// One history of good and bad readings, and the Gaussian that follows from it.
template <int N>
struct Hypothesis {
  Vector<N> deviation = Vector<N>::Zero();  ///< from the summary's mean; small, so that wrapped states can be added
  Matrix<N> covariance = Matrix<N>::Zero();
  double log_weight = 0;
  std::uint64_t biased = 0;  ///< rows that are in their bias mode, a bit each
  std::size_t scale = 0;     ///< of the process noise in the present epoch
};

/// A part of the states as a sum of Gaussians [Sorenson1971]; vectors and matrices are zero at the others.
template <int N>
struct GaussianBlock {
  Vector<N> states = Vector<N>::Ones();  ///< 1 for each that is in the block, 0 for the others
  std::vector<Hypothesis<N>> hypotheses{};

  Matrix<N> own(const Matrix<N>& all) const { return states.asDiagonal() * all * states.asDiagonal(); }
  /// Normalises the logarithms of the weights and returns the weights. Those that underflow are zero.
  std::vector<double> normalize();
  /// Merges hypotheses whose squared distance a state to a heavier one is below `merge`, and keeps the `count` heaviest
  /// [Salmond1990].
  void reduce(std::size_t count, double merge);
};

/// A belief of one sum of Gaussians for each block of uncoupled states, with its mean and covariance. Two independent
/// blocks of 48 hypotheses stand for 48 times 48.
template <int N>
struct GaussianSum {
  static constexpr int kRows = 4;  ///< of a source
  static constexpr std::size_t kChannels = kRows * kMaxSources;

  Gaussian<N> summary;
  std::vector<GaussianBlock<N>> blocks{};  ///< none: the summary alone
  bool epoch_over = true;                  ///< the next prediction begins an epoch of the process noise
  double epoch_end = NAN;                  ///< [s]
  std::array<std::optional<double>, kChannels> mode_time{};  ///< last evaluation of a channel's mode [s]

  /// Divides the summary into the blocks that its covariance does not couple, unless there are blocks already.
  void start();
  /// Joins blocks wherever `coupling` is not zero: forms all pairs of their hypotheses and reduces them.
  void couple(const Matrix<N>& coupling, std::size_t count, double merge);
  /// Computes mean and covariance from the hypotheses, and refers their deviations to this mean.
  void summarize();
};

template <int N>
const Gaussian<N>& gaussian(const GaussianSum<N>& belief) {
  return belief.summary;
}

}  // namespace sas_motion

#include "sas_motion/filters/impl/gaussian_sum.hpp"
