// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace sas_motion {

/// Weights of particles, kept as logarithms so that products of small likelihoods do not underflow.
class ParticleWeights {
 public:
  /// Throws std::invalid_argument where there are none.
  explicit ParticleWeights(std::size_t count);

  void makeEqual();
  /// Multiplies by a likelihood; one that is not a number, or infinite, is taken for 0.
  void multiply(std::size_t particle, double log_likelihood);
  /// Makes them add up to 1. Where every one is 0 they become equal, and the answer is false: no particle explains what
  /// was measured.
  bool normalise();

  /// Of the last normalise().
  const std::vector<double>& values() const { return values_; }
  /// 1 / sum w^2, from 1 to the number of particles.
  double effectiveSize() const;
  std::size_t heaviest() const;

 private:
  std::vector<double> logarithms_, values_;
};

/// Systematic resampling: `parents` gets the particle that each new one comes from, in rising order, as often as its
/// weight says give or take one. `uniform` is in [0, 1). [Kitagawa1996]
void resampleSystematically(const std::vector<double>& weights, double uniform, std::vector<std::size_t>& parents);

}  // namespace sas_motion
