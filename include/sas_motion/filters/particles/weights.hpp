// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace sas_motion {

/// Weights of particles, stored as logarithms so that products of small likelihoods do not underflow.
class ParticleWeights {
 public:
  /// Throws std::invalid_argument where there are none.
  explicit ParticleWeights(std::size_t count);

  void makeEqual();
  /// Multiplies by a likelihood. NaN and infinity count as 0.
  void multiply(std::size_t particle, double log_likelihood);
  /// Scales the weights to the sum 1. Where all are 0 it makes them equal and returns false.
  bool normalise();

  /// The weights after the last normalise().
  const std::vector<double>& values() const { return values_; }
  /// 1 / sum w^2, from 1 to the number of particles.
  double effectiveSize() const;
  std::size_t heaviest() const;

 private:
  std::vector<double> logarithms_, values_;
};

/// Systematic resampling: fills `parents` with the parent of each new particle, in rising order. A parent occurs as
/// often as its weight demands, give or take one. `uniform` is in [0, 1). [Kitagawa1996]
void resampleSystematically(const std::vector<double>& weights, double uniform, std::vector<std::size_t>& parents);

}  // namespace sas_motion
