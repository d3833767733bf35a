// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/particles/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sas_motion {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

}  // namespace

ParticleWeights::ParticleWeights(std::size_t count) : logarithms_(count), values_(count) {
  if (count == 0) throw std::invalid_argument("the number of particles is 0 but must be positive");
  makeEqual();
}

void ParticleWeights::makeEqual() {
  std::fill(logarithms_.begin(), logarithms_.end(), 0.0);
  std::fill(values_.begin(), values_.end(), 1.0 / static_cast<double>(values_.size()));
}

void ParticleWeights::multiply(std::size_t particle, double log_likelihood) {
  logarithms_[particle] = std::isfinite(log_likelihood) ? logarithms_[particle] + log_likelihood : kNone;
}

bool ParticleWeights::normalise() {
  const double largest = *std::max_element(logarithms_.begin(), logarithms_.end());
  if (largest == kNone) {
    makeEqual();
    return false;
  }
  double sum = 0;
  for (std::size_t i = 0; i < values_.size(); ++i) sum += values_[i] = std::exp(logarithms_[i] -= largest);
  for (auto& value : values_) value /= sum;
  return true;
}

double ParticleWeights::effectiveSize() const {
  double squares = 0;
  for (const double value : values_) squares += value * value;
  return 1 / squares;
}

std::size_t ParticleWeights::heaviest() const {
  return static_cast<std::size_t>(std::max_element(values_.begin(), values_.end()) - values_.begin());
}

void resampleSystematically(const std::vector<double>& weights, double uniform, std::vector<std::size_t>& parents) {
  const auto count = static_cast<double>(parents.size());
  std::size_t last = weights.size() - 1;  // the last particle with weight, which rounding must not pass
  while (last > 0 && !(weights[last] > 0)) --last;
  std::size_t parent = 0;
  double sum = weights[0];
  for (std::size_t i = 0; i < parents.size(); ++i) {
    while (parent < last && sum <= (static_cast<double>(i) + uniform) / count) sum += weights[++parent];
    parents[i] = parent;
  }
}

}  // namespace sas_motion
