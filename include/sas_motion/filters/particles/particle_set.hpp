// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "sas_motion/filters/particles/weights.hpp"
#include "sas_motion/filters/update.hpp"
#include "sas_motion/math/counter_random.hpp"
#include "sas_motion/math/factorization.hpp"
#include "sas_motion/parallel/threads.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Options of every particle filter.
struct ParticleOptions {
  int particles = 1200;
  double resample_below = 0.5;  ///< effective size over the number of particles
  int threads = 1;              ///< the results are the same for any number
  std::uint64_t seed = 1;
  std::optional<Loss> loss;  ///< against outliers: multiplies a row's noise by 1 / weight, for all particles alike
};

/// The result of one update of a particle filter. The verdict is Invalid where z cannot be used, or where its
/// likelihood is 0 for all particles; these then get equal weights.
template <int M>
struct ParticleUpdate {
  Vector<M> innovation = Vector<M>::Zero();  ///< z less the mean of h
  Matrix<M> S = Matrix<M>::Zero();           ///< covariance of the innovation, by the particles
  double nis = 0;
  Vector<M> weights = Vector<M>::Ones();  ///< by row, of the loss
  double effective_size = 0;              ///< before any resampling
  bool resampled = false;
  Verdict verdict = Verdict::Invalid;
};

/// The particles of a filter in two buffers, with their weights, threads and random numbers. Copies share the threads,
/// so only one of them may run at a time.
template <class Particle>
class ParticleSet {
 public:
  explicit ParticleSet(const ParticleOptions& options)
      : options_(options),
        weights_(static_cast<std::size_t>(std::max(0, options.particles))),
        particles_(static_cast<std::size_t>(options.particles)),
        others_(particles_.size()),
        predicted_(particles_.size() * kMostRows),
        parents_(particles_.size()),
        team_(std::make_shared<ThreadTeam>(options.threads)) {}

  std::size_t size() const { return particles_.size(); }
  Particle& operator[](std::size_t i) { return particles_[i]; }
  const Particle& operator[](std::size_t i) const { return particles_[i]; }
  ParticleWeights& weights() { return weights_; }
  const ParticleWeights& weights() const { return weights_; }
  const ParticleOptions& options() const { return options_; }

  /// Calls `work(first, count)` for blocks of `together` particles; the last may have fewer.
  template <class Work>
  void forEachBlock(std::size_t together, const Work& work) {
    team_->forEach((size() + together - 1) / together,
                   [&](std::size_t task) { work(task * together, std::min(together, size() - task * together)); });
  }

  /// Calls `work(i)` for every particle.
  template <class Work>
  void forEach(const Work& work) {
    forEachBlock(24, [&](std::size_t first, std::size_t count) {
      for (std::size_t i = first; i < first + count; ++i) work(i);
    });
  }

  /// Starts the random numbers of another step.
  void nextStep() { ++step_; }
  CounterRandom random(std::size_t i) const { return {options_.seed, {0, step_, static_cast<std::uint32_t>(i)}}; }
  template <int N>
  Vector<N> gaussians(std::size_t i) const {
    CounterRandom source = random(i);
    Vector<N> draws;
    for (int row = 0; row < N; ++row) draws(row) = source.gaussian();
    return draws;
  }

  /// Computes innovation, covariance and the rows' weights from `h` of each particle's state. `own` is the mean
  /// covariance of h within one particle.
  template <int M, class State, class Function, class Difference>
  ParticleUpdate<M> examine(const Vector<M>& z, const Function& h, const Matrix<M>& R, const Matrix<M>& own,
                            const Difference& difference, const State& state) {
    static_assert(M <= kMostRows);
    const auto predicted = [&](std::size_t i) { return Eigen::Map<Vector<M>>(predicted_.data() + kMostRows * i); };
    forEach([&](std::size_t i) { predicted(i) = h(state(particles_[i])); });
    const Vector<M> reference = predicted(weights_.heaviest());
    Vector<M> mean = Vector<M>::Zero();
    Matrix<M> square = Matrix<M>::Zero();
    for (std::size_t i = 0; i < size(); ++i) {
      const Vector<M> offset = difference(Vector<M>(predicted(i)), reference);
      if (!offset.allFinite()) continue;
      mean += weights_.values()[i] * offset;
      square += weights_.values()[i] * offset * offset.transpose();
    }
    ParticleUpdate<M> update;
    update.innovation = difference(z, Vector<M>(reference + mean));
    update.S = R + own + square - mean * mean.transpose();
    const auto root = choleskyLower<M>(update.S);
    if (!root || !update.innovation.allFinite() || !choleskyLower<M>(R)) return update;
    update.nis = root->template triangularView<Eigen::Lower>().solve(update.innovation).squaredNorm();
    if (options_.loss)
      for (int row = 0; row < M; ++row)
        update.weights(row) = options_.loss->weight(update.innovation(row) / std::sqrt(update.S(row, row)));
    update.verdict = verdictFromWeights<M>(update.weights);
    return update;
  }

  /// The root of R with the rows' variances divided by their weights.
  template <int M>
  static Matrix<M> noiseRoot(const Matrix<M>& R, const Vector<M>& weights) {
    return weights.cwiseMax(kTiny).cwiseSqrt().cwiseInverse().asDiagonal() * choleskyLower<M>(R).value();
  }

  /// Normalises the weights, and resamples where the effective number is too small. `renew(particle, copied, i)`
  /// completes the i-th new particle; `copied` says whether its parent has several.
  template <int M, class Renew>
  void weigh(ParticleUpdate<M>& update, const Renew& renew) {
    if (!weights_.normalise()) {
      update.verdict = Verdict::Invalid;
      return;
    }
    update.effective_size = weights_.effectiveSize();
    update.resampled = update.effective_size < options_.resample_below * static_cast<double>(size());
    if (!update.resampled) return;
    nextStep();
    resampleSystematically(weights_.values(), random(size()).uniform(), parents_);
    forEach([&](std::size_t i) {
      others_[i] = particles_[parents_[i]];
      const bool after = i > 0 && parents_[i - 1] == parents_[i],
                 before = i + 1 < size() && parents_[i + 1] == parents_[i];  // they are in order
      renew(others_[i], after || before, i);
    });
    particles_.swap(others_);
    weights_.makeEqual();
    nextStep();
  }

 private:
  static constexpr int kMostRows = 6;
  static constexpr double kTiny = 1e-9;

  ParticleOptions options_;
  ParticleWeights weights_;
  std::vector<Particle> particles_, others_;
  std::vector<double> predicted_;
  std::vector<std::size_t> parents_;
  std::shared_ptr<ThreadTeam> team_;
  std::uint32_t step_ = 0;
};

/// Calls `add(i, weight)` for every particle that has weight and is finite. Returns the sum of the weights.
template <class Particles, class State, class Add>
double overFinite(const Particles& particles, const State& state, const Add& add) {
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (const double weight = particles.weights().values()[i]; weight > 0 && state(particles[i]).allFinite()) {
      add(i, weight);
      sum += weight;
    }
  return sum;
}

/// The mean of weighted states, without those that are not finite.
template <int N, class Particles, class State>
Vector<N> meanOf(const Particles& particles, const State& state) {
  Vector<N> mean = Vector<N>::Zero();
  const double sum =
      overFinite(particles, state, [&](std::size_t i, double weight) { mean += weight * state(particles[i]); });
  return mean / sum;
}

/// The mean and covariance of weighted states, without those that are not finite.
template <int N, class Particles, class State>
Gaussian<N> momentsOf(const Particles& particles, const State& state) {
  Gaussian<N> moments{meanOf<N>(particles, state), Matrix<N>::Zero()};
  const double sum = overFinite(particles, state, [&](std::size_t i, double weight) {
    const Vector<N> offset = state(particles[i]) - moments.mean;
    moments.covariance.noalias() += weight * offset * offset.transpose();
  });
  moments.covariance /= sum;
  return moments;
}

}  // namespace sas_motion
