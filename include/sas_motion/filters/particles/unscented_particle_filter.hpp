// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/filters/particles/belief_form.hpp"
#include "sas_motion/filters/particles/gaussian_density.hpp"
#include "sas_motion/filters/particles/particle_set.hpp"
#include "sas_motion/filters/sigma_image.hpp"

namespace sas_motion {

/// The weights of the particles of an unscented particle filter.
enum class Weighting {
  Mixture,  ///< a particle is a Gaussian of a mixture, weighted by its predicted density of z; copies are drawn from it
  OptimalProposal,  ///< a particle is a point, moved by a draw from p(x | its last point, z)
  Literal,          ///< a particle is a point with a filter of its own, moved by a draw from its posterior [Merwe2000]
};

struct UnscentedParticleOptions : ParticleOptions {
  Weighting weighting = Weighting::Mixture;
  double kept =
      0.95;  ///< share of a Gaussian's covariance that each copy keeps; the means of the copies are drawn from the rest
};

/// A particle filter whose particles each run a sigma-point filter; `Filter` runs those of a block. With
/// SigmaPointFilter OneByOne and unscented points it is the UPF [Merwe2000], with SimplexBlocks, or SimplexFilter
/// OneByOne, the SS-SRUPF [Li2014].
///
/// A step allocates nothing. Its results depend on the seed, not on the number of threads. With a single particle it is
/// that filter.
template <int N, class Filter>
class UnscentedParticleFilter {
 public:
  using Belief = typename Filter::Belief;
  struct Particle {
    Belief belief;
    Vector<N> moved;  ///< the last point, moved by the model alone
  };

  /// Throws std::invalid_argument where there are no particles.
  UnscentedParticleFilter(const Filter& filter, const UnscentedParticleOptions& options)
      : filter_(filter), weighting_(options.weighting), kept_(options.kept), particles_(options) {}

  /// Draws the particles from a belief; false where its covariance is not positive definite.
  bool start(const Gaussian<N>& belief) { return start(belief, belief.covariance); }

  /// The same, with Gaussians of the mixture no wider than a copy of `own`, so that functions are nearly linear over
  /// each.
  bool start(const Gaussian<N>& belief, const Matrix<N>& own) {
    const auto root = choleskyLower<N>(belief.covariance), drawn = choleskyLower<N>(belief.covariance - kept_ * own),
               kept = choleskyLower<N>(kept_ * own);
    if (!root || !drawn || !kept) return false;
    particles_.nextStep();
    noise_root_.setZero();
    const bool mixture = weighting_ == Weighting::Mixture, alone = mixture && particles_.size() == 1;
    particles_.forEach([&](std::size_t i) {
      const Matrix<N>& spread = mixture ? *drawn : *root;
      particles_[i].belief = Form::of(belief.mean, mixture && !alone ? *kept : *root);
      move(particles_[i], alone ? belief.mean : Vector<N>(belief.mean + spread * particles_.template gaussians<N>(i)));
    });
    particles_.weights().makeEqual();
    return true;
  }

  /// x' = f(x) + w, w ~ N(0, Q_root Q_root^T). A particle that is no longer finite gets the weight 0.
  template <class Function>
  void predict(const Function& f, const Matrix<N>& Q_root) {
    addSquares<N, N>(noise_root_, Q_root);
    particles_.forEachBlock(Filter::kTogether, [&](std::size_t first, std::size_t count) {
      if (weighting_ != Weighting::Mixture)
        for (std::size_t i = first; i < first + count; ++i) particles_[i].moved = f(particles_[i].moved);
      if (weighting_ == Weighting::OptimalProposal)
        for (std::size_t i = first; i < first + count; ++i)
          particles_[i].belief = Form::of(particles_[i].moved, noise_root_);
      else
        filter_.predict(static_cast<int>(count), beliefsFrom(first), f, Q_root, [&](int k) {
          particles_.weights().multiply(first + static_cast<std::size_t>(k), std::numeric_limits<double>::quiet_NaN());
        });
    });
  }

  /// Draws a step from N(0, root root^T) for every particle, for noise that is too wide for one Gaussian. A single
  /// particle gets a larger covariance instead.
  void roughen(const Matrix<N>& root) {
    particles_.nextStep();
    particles_.forEach([&](std::size_t i) {
      Particle& particle = particles_[i];
      if (particles_.size() == 1)
        Form::widen(particle.belief, root);
      else
        move(particle, particle.belief.mean + root * particles_.template gaussians<N>(i));
    });
    if (particles_.size() == 1) addSquares<N, N>(noise_root_, root);
  }

  /// Updates with z = h(x) + v, v ~ N(0, R).
  template <int M, class Function, class Difference = PlainDifference>
  ParticleUpdate<M> update(const Vector<M>& z, const Function& h, const Matrix<M>& R,
                           const Difference& difference = {}) {
    auto update = particles_.template examine<M>(z, h, R, ownCovariance<M>(h, difference), difference, state);
    if (update.verdict == Verdict::Invalid) return update;
    const Matrix<M> R_root = particles_.noiseRoot(R, update.weights);
    particles_.nextStep();
    particles_.forEachBlock(Filter::kTogether, [&](std::size_t first, std::size_t count) {
      filter_.template update<M>(
          static_cast<int>(count), beliefsFrom(first), z, h, R_root, difference, [&](int k, double log_likelihood) {
            const std::size_t i = first + static_cast<std::size_t>(k);
            const bool draws = weighting_ != Weighting::Mixture && std::isfinite(log_likelihood);
            particles_.weights().multiply(i, draws ? draw<M>(i, z, h, R_root, difference) : log_likelihood);
          });
    });
    particles_.weigh(update, [&](Particle& particle, bool copied, std::size_t i) {
      if (copied && weighting_ == Weighting::Mixture) split(particle, i);
    });
    noise_root_.setZero();
    return update;
  }

  /// Replaces every particle's state by a function of it, for example to keep a constraint.
  template <class Function>
  void replace(const Function& function) {
    particles_.forEach([&](std::size_t i) { move(particles_[i], function(particles_[i].belief.mean)); });
  }

  Gaussian<N> belief() const {
    if (weighting_ != Weighting::Mixture) return momentsOf<N>(particles_, state);
    Gaussian<N> moments{mean(), Matrix<N>::Zero()};
    std::array<const Belief*, kGathered> beliefs;
    std::array<double, kGathered> weights;
    int count = 0;
    const auto add_gathered = [&] {
      filter_.addMoments(
          count, [&](int k) -> const Belief& { return *beliefs[static_cast<std::size_t>(k)]; },
          [&](int k) { return weights[static_cast<std::size_t>(k)]; }, moments.mean, moments.covariance);
      count = 0;
    };
    const double sum = overFinite(particles_, state, [&](std::size_t i, double weight) {
      beliefs[static_cast<std::size_t>(count)] = &particles_[i].belief;
      weights[static_cast<std::size_t>(count)] = weight;
      if (++count == kGathered) add_gathered();
    });
    if (count > 0) add_gathered();
    moments.covariance /= sum;
    return moments;
  }
  /// The mean of belief(), at less cost.
  Vector<N> mean() const { return meanOf<N>(particles_, state); }
  const ParticleSet<Particle>& particles() const { return particles_; }

 private:
  using Form = BeliefForm<Belief>;
  static constexpr int kGathered = 64;

  static const Vector<N>& state(const Particle& particle) { return particle.belief.mean; }
  auto beliefsFrom(std::size_t first) {
    return [this, first](int k) -> Belief& { return particles_[first + static_cast<std::size_t>(k)].belief; };
  }

  /// The covariance of h within the particle of largest weight, which stands for all of them.
  template <int M, class Function, class Difference>
  Matrix<M> ownCovariance(const Function& h, const Difference& difference) const {
    const auto image =
        filter_.one().template project<M>(particles_[particles_.weights().heaviest()].belief, h, difference);
    return image ? filter_.one().template secondMoment<M, M>(image->deviations, image->deviations)
                 : Matrix<M>(Matrix<M>::Zero());
  }

  /// Draws a particle from the posterior of its filter. Returns the logarithm of the factor of its weight.
  template <int M, class Function, class Difference>
  double draw(std::size_t i, const Vector<M>& z, const Function& h, const Matrix<M>& R_root,
              const Difference& difference) {
    Particle& particle = particles_[i];
    const auto root = Form::root(particle.belief);
    if (!root) return std::numeric_limits<double>::quiet_NaN();
    const Vector<N> step = *root * particles_.template gaussians<N>(i), x = particle.belief.mean + step;
    const double likelihood = logDensity<M>(difference(z, Vector<M>(h(x))), R_root);
    const double transition = logDensity<N>(x - particle.moved, noise_root_), proposal = logDensity<N>(step, *root);
    move(particle, x);
    return likelihood + transition - proposal;  // (B.8)
  }

  static void move(Particle& particle, const Vector<N>& x) { particle.moved = particle.belief.mean = x; }

  /// Draws the mean of a copy from its parent's Gaussian and narrows it, so that all copies together have the parent's
  /// covariance.
  void split(Particle& particle, std::size_t i) const {
    const auto root = Form::root(particle.belief);
    if (!root) return;
    move(particle, particle.belief.mean + std::sqrt(1 - kept_) * (*root * particles_.template gaussians<N>(i)));
    Form::scale(particle.belief, kept_);
  }

  Filter filter_;
  Weighting weighting_;
  double kept_;
  ParticleSet<Particle> particles_;
  Matrix<N> noise_root_ = Matrix<N>::Zero();  // of all predictions since the last update
};

template <class Filter>
UnscentedParticleFilter(const Filter&, const UnscentedParticleOptions&)
    -> UnscentedParticleFilter<decltype(Filter::Belief::mean)::RowsAtCompileTime, Filter>;

}  // namespace sas_motion
