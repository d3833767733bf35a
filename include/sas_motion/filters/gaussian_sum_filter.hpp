// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>

#include "sas_motion/filters/gaussian_sum.hpp"
#include "sas_motion/filters/update.hpp"

namespace sas_motion {

/// One Gaussian of a noise law, in units of the good standard deviation.
struct NoiseTerm {
  double variance = 1;
  double probability = 1;  ///< relative to the sum over all terms [-]
  double mean = 0;
};

/// Spells in which a row is biased: they begin `rate` times a second and last `length` seconds on average.
struct BiasMode {
  double rate = 0;               ///< 0: there are none [1/s]
  double length = 1;             ///< [s]
  std::optional<double> bias{};  ///< in standard deviations; without a value it is unknown and the row is not used [-]
  bool common = false;           ///< all rows have spells at the same time; else each on its own
  std::uint64_t rows = std::numeric_limits<std::uint64_t>::max();  ///< rows that have spells: bit 4 source + row
};

/// The laws of the noise, and the number of hypotheses.
struct GaussianSumOptions {
  std::vector<NoiseTerm> measurement = std::vector<NoiseTerm>(1);  ///< of each row
  std::vector<NoiseTerm> process =
      std::vector<NoiseTerm>(1);  ///< variances over Q, of all states together; without means
  double epoch = 0;               ///< duration of a process term; 0: from an update to the next prediction [s]
  double persistence = 0;         ///< probability that the next epoch keeps the term [-]
  BiasMode mode;
  std::size_t hypotheses = 48;  ///< kept after an update
  std::size_t branches = 160;   ///< followed inside an update
  double merge = 0.1;  ///< squared distance a state below which two hypotheses become one: in standard deviations, and
                       ///< of the logarithms of variances [-]
};

/// Returns the options with probabilities that add up to 1. Throws std::invalid_argument where one is out of its range.
GaussianSumOptions checked(GaussianSumOptions options);

template <int N>
struct GaussianSumRow;

/// The Bayes filter of known, non-Gaussian noise as far as it can be computed: a reference for causal estimators.
///
/// Every Gaussian of every noise law opens a branch: a Kalman filter that assumes it. The branches of largest weight
/// are kept, similar ones merged [Sorenson1971]. States are in separate blocks until the start, the motion, a row, a
/// scale of the process noise or a mode of several rows couples them. The scale of the process noise branches at the
/// first prediction of an epoch; an epoch ends with the first update at or after a multiple of its length. A mode may
/// be on from the start. Rows are fused one by one, R is diagonal. With one term each this is the Kalman filter.
template <int N>
class GaussianSumFilter {
 public:
  using Belief = GaussianSum<N>;

  /// Throws std::invalid_argument where an option is out of its range.
  explicit GaussianSumFilter(const GaussianSumOptions& options) : options_(checked(options)) {}

  Belief predict(const Belief& belief, const Transition<N>& transition) const;

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;

 private:
  void branch(GaussianBlock<N>& block) const;
  bool modal(std::uint64_t channel) const;
  void askMode(Belief& belief, std::uint64_t channel, double time, GaussianSumRow<N>& row) const;
  void endEpoch(Belief& belief, double time) const;

  GaussianSumOptions options_;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/gaussian_sum_filter.hpp"
