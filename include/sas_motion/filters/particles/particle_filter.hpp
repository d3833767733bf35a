// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/particles/crowd.hpp"
#include "sas_motion/filters/particles/gaussian_density.hpp"
#include "sas_motion/filters/sigma_image.hpp"

namespace sas_motion {

/// The bootstrap filter, sampling importance resampling: particles move by the model, with noise drawn for each, and
/// are weighed by how well they explain what is measured. [Gordon1993]
///
/// A step allocates nothing. Its results depend on the seed, not on the number of threads.
template <int N>
class ParticleFilter {
 public:
  /// Throws std::invalid_argument where there are no particles.
  explicit ParticleFilter(const ParticleOptions& options) : crowd_(options) {}

  /// Draws the particles from a belief; false where its covariance is not positive definite.
  bool start(const Gaussian<N>& belief) {
    const auto root = choleskyLower<N>(belief.covariance);
    if (!root) return false;
    crowd_.nextStep();
    crowd_.forEach([&](std::size_t i) { crowd_[i] = belief.mean + *root * crowd_.template gaussians<N>(i); });
    crowd_.weights().makeEqual();
    return true;
  }

  /// x' = f(x) + w, w ~ N(0, Q_root Q_root^T). A particle that comes to where numbers are not finite has no weight from
  /// then on.
  template <class Function>
  void predict(const Function& f, const Matrix<N>& Q_root) {
    crowd_.nextStep();
    crowd_.forEach([&](std::size_t i) { crowd_[i] = f(crowd_[i]) + Q_root * crowd_.template gaussians<N>(i); });
  }

  /// Draws a step from N(0, root root^T) for every particle.
  void scatter(const Matrix<N>& root) {
    crowd_.nextStep();
    crowd_.forEach([&](std::size_t i) { crowd_[i] += root * crowd_.template gaussians<N>(i); });
  }

  /// After reading z = h(x) + v, v ~ N(0, R).
  template <int M, class Function, class Difference = PlainDifference>
  ParticleUpdate<M> update(const Vector<M>& z, const Function& h, const Matrix<M>& R,
                           const Difference& difference = {}) {
    auto update = crowd_.template examine<M>(z, h, R, Matrix<M>(Matrix<M>::Zero()), difference, state);
    if (update.verdict == Verdict::Invalid) return update;
    const Matrix<M> R_root = crowd_.noiseRoot(R, update.weights);
    crowd_.forEach([&](std::size_t i) {
      crowd_.weights().multiply(i, logDensity<M>(difference(z, Vector<M>(h(crowd_[i]))), R_root));
    });
    crowd_.weigh(update, [](Vector<N>&, bool, std::size_t) {});
    return update;
  }

  /// Replaces every particle by a function of it, as to keep a constraint.
  template <class Function>
  void replace(const Function& function) {
    crowd_.forEach([&](std::size_t i) { crowd_[i] = function(crowd_[i]); });
  }

  Gaussian<N> belief() const { return momentsOf<N>(crowd_, state); }
  /// That of belief(), at less cost.
  Vector<N> mean() const { return meanOf<N>(crowd_, state); }
  const Crowd<Vector<N>>& particles() const { return crowd_; }

 private:
  static const Vector<N>& state(const Vector<N>& x) { return x; }

  Crowd<Vector<N>> crowd_;
};

}  // namespace sas_motion
