// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/particles/gaussian_density.hpp"
#include "sas_motion/filters/particles/particle_set.hpp"
#include "sas_motion/filters/sigma_image.hpp"

namespace sas_motion {

/// The bootstrap filter (sampling importance resampling): particles move by the model with drawn noise and are weighted
/// by the likelihood of the measurement. [Gordon1993]
///
/// A step allocates nothing. Its results depend on the seed, not on the number of threads.
template <int N>
class ParticleFilter {
 public:
  /// Throws std::invalid_argument where there are no particles.
  explicit ParticleFilter(const ParticleOptions& options) : particles_(options) {}

  /// Draws the particles from a belief; false where its covariance is not positive definite.
  bool start(const Gaussian<N>& belief) {
    const auto root = choleskyLower<N>(belief.covariance);
    if (!root) return false;
    particles_.nextStep();
    particles_.forEach(
        [&](std::size_t i) { particles_[i] = belief.mean + *root * particles_.template gaussians<N>(i); });
    particles_.weights().makeEqual();
    return true;
  }

  /// x' = f(x) + w, w ~ N(0, Q_root Q_root^T). A particle that is no longer finite gets the weight 0.
  template <class Function>
  void predict(const Function& f, const Matrix<N>& Q_root) {
    particles_.nextStep();
    particles_.forEach(
        [&](std::size_t i) { particles_[i] = f(particles_[i]) + Q_root * particles_.template gaussians<N>(i); });
  }

  /// Draws a step from N(0, root root^T) for every particle.
  void roughen(const Matrix<N>& root) {
    particles_.nextStep();
    particles_.forEach([&](std::size_t i) { particles_[i] += root * particles_.template gaussians<N>(i); });
  }

  /// Updates with z = h(x) + v, v ~ N(0, R).
  template <int M, class Function, class Difference = PlainDifference>
  ParticleUpdate<M> update(const Vector<M>& z, const Function& h, const Matrix<M>& R,
                           const Difference& difference = {}) {
    auto update = particles_.template examine<M>(z, h, R, Matrix<M>(Matrix<M>::Zero()), difference, state);
    if (update.verdict == Verdict::Invalid) return update;
    const Matrix<M> R_root = particles_.noiseRoot(R, update.weights);
    particles_.forEach([&](std::size_t i) {
      particles_.weights().multiply(i, logDensity<M>(difference(z, Vector<M>(h(particles_[i]))), R_root));
    });
    particles_.weigh(update, [](Vector<N>&, bool, std::size_t) {});
    return update;
  }

  /// Replaces every particle by a function of it, for example to keep a constraint.
  template <class Function>
  void replace(const Function& function) {
    particles_.forEach([&](std::size_t i) { particles_[i] = function(particles_[i]); });
  }

  Gaussian<N> belief() const { return momentsOf<N>(particles_, state); }
  /// The mean of belief(), at less cost.
  Vector<N> mean() const { return meanOf<N>(particles_, state); }
  const ParticleSet<Vector<N>>& particles() const { return particles_; }

 private:
  static const Vector<N>& state(const Vector<N>& x) { return x; }

  ParticleSet<Vector<N>> particles_;
};

}  // namespace sas_motion
