// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include "sas_motion/filters/influence_averages.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/robust/loss_moments.hpp"
#include "sas_motion/robust/variational_noise.hpp"

namespace sas_motion {

/// What the weight of a row changes: its noise, or its reading, which is moved towards the estimate. Both have the same
/// fixed point.
enum class Reweighting { Covariance, Observation };

/// The share of a row's normalised squared residual that enters the noise estimate: 1; its weight w; w^2 (the
/// pseudo-observation); w^2 over its mean for good noise; or the posterior share of good noise in a mixture.
enum class NoiseIncrement { Raw, Weighted, Pseudo, Consistent, Mixture };

struct AdaptiveCubatureOptions {
  bool adaptive = false;     ///< estimate the noise by variational Bayes; else use the stated R
  std::optional<Loss> loss;  ///< re-weights the rows, if given
  double peak =
      1;  ///< weight of a residual of 0: (nu + 1) / nu of Student's t, whose loss is Cauchy's with c = sqrt(nu)
  Reweighting reweighting = Reweighting::Covariance;
  NoiseIncrement increment = NoiseIncrement::Mixture;
  int iterations = 5;
  double tolerance = 1e-9;  ///< largest change of the mean at the end, in standard deviations
  double rho = 0.97;        ///< factor of earlier readings' weight in the noise estimate at each step, in (0, 1]
  double trend = 1;         ///< 0 to 1, see VariationalNoise
  double clamp = 100;       ///< the noise estimate stays within this factor of the stated variance
  bool calibrate = false;   ///< report a covariance computed from the readings' influence, not the filter's own
};

/// A state, the noise of each channel over its stated variance, and the filter's own covariance beside the reported
/// one.
template <int N, int M>
struct AdaptiveBelief {
  Gaussian<N> state;
  Matrix<N> own = Matrix<N>::Identity();
  VariationalNoise<M> noise{};
  InfluenceAverages<M> influence{};

  AdaptiveBelief() = default;
  explicit AdaptiveBelief(const Gaussian<N>& belief) : state(belief), own(belief.covariance) {}
};

template <int N, int M>
const Gaussian<N>& gaussian(const AdaptiveBelief<N, M>& belief) {
  return belief.state;
}

/// The cubature Kalman filter of constant parameters with either or both of a variational-Bayes noise estimate and
/// M-estimation: CKF, C-VBCKF, C-HCKF and C-HVBCKF are its four settings. [ZhangTao, eq 12 to 28; Sarkka2013;
/// Chang2013]
template <int N, int M>
class AdaptiveCubatureFilter {
 public:
  using Belief = AdaptiveBelief<N, M>;
  using Options = AdaptiveCubatureOptions;

  explicit AdaptiveCubatureFilter(const Options& options)
      : options_(options),
        consistency_(options.loss ? gaussianMeanSquaredInfluence(*options.loss) : 1),
        points_(cubaturePoints<N>()) {}

  Belief predict(const Belief& belief, const Matrix<N>& Q) const {
    Belief prior = belief;
    prior.state.covariance += Q;
    prior.own += Q;
    return prior;
  }

  /// The belief after reading z = h(x) + v with v of the stated variances, or some multiple of them. Rows where
  /// `present` is 0 are left out; elsewhere it is 1. z must be finite and the variance positive in all rows. The
  /// weights of the result are those of the rows, S and NIS those with the estimated noise.
  template <class Function, class Difference>
  Update<Belief, M> update(const Belief& prior, const Vector<M>& z, const Vector<M>& variance, const Vector<M>& present,
                           const Function& h, const Difference& difference) const {
    Update<Belief, M> result;
    result.belief = prior;
    result.verdict = Verdict::Invalid;
    const Gaussian<N> own{prior.state.mean, prior.own};
    auto image = points_.template project<M>(own, h, difference);
    if (!image) return result;
    image->deviations = present.asDiagonal() * image->deviations;
    const auto residual = [&](const Vector<M>& predicted) {
      return Vector<M>(difference(z, predicted).cwiseProduct(present));
    };

    Iterate iterate{own, options_.adaptive ? prior.noise.faded(options_.rho) : prior.noise, {}, {}, Vector<M>::Ones()};
    const VariationalNoise<M> faded = iterate.noise;
    result.converged = false;
    for (int j = 0; j < options_.iterations && !result.converged; ++j) {
      iterate.residual = residual(h(iterate.belief.mean));
      reweigh(iterate, variance, present);
      const bool by_covariance = options_.reweighting == Reweighting::Covariance;
      const Vector<M> R = by_covariance ? Vector<M>(iterate.R.cwiseQuotient(iterate.weights)) : iterate.R;
      Vector<M> innovation = residual(image->mean);
      if (!by_covariance) innovation -= iterate.residual.cwiseProduct(Vector<M>::Ones() - iterate.weights);
      const auto step = points_.template condition<M>(own, *image, innovation, R.asDiagonal());
      if (step.verdict == Verdict::Invalid) return result;
      if (j == 0) result.innovation = step.innovation, result.S = step.S, result.nis = step.nis;
      const Vector<N> moved = step.belief.mean - iterate.belief.mean;
      result.converged =
          (moved.array().abs() <= options_.tolerance * step.belief.covariance.diagonal().array().sqrt()).all();
      result.iterations = j + 1;
      iterate.belief = step.belief;
      if (options_.adaptive && !learnNoise(iterate, faded, variance, present, residual, h, difference)) return result;
    }
    result.converged |= !options_.loss && !options_.adaptive;
    result.weights = iterate.weights.cwiseMin(1.0);
    result.verdict = verdictFromWeights(result.weights);
    result.belief.state.mean = iterate.belief.mean;
    result.belief.own = iterate.belief.covariance;
    result.belief.noise = iterate.noise;
    iterate.residual = residual(h(iterate.belief.mean));
    reportCovariance(prior, *image, iterate, present, result.belief);
    return result;
  }

 private:
  using Points = CubatureKalmanFilter<N>;
  using Image = typename Points::template Image<M>;

  /// The state of the iteration.
  struct Iterate {
    Gaussian<N> belief;
    VariationalNoise<M> noise;
    Vector<M> residual, R, weights;  ///< of each row: z - h(x), estimated noise, weight
  };

  /// A row's weight at its residual over the estimated noise; absent rows get 1. [ZhangTao, eq 21]
  void reweigh(Iterate& iterate, const Vector<M>& variance, const Vector<M>& present) const {
    iterate.R = options_.adaptive ? Vector<M>(variance.cwiseProduct(iterate.noise.factor(options_.trend))) : variance;
    for (int row = 0; row < M; ++row)
      iterate.weights(row) =
          options_.loss && present(row) > 0
              ? std::max(kLeastWeight,
                         options_.peak * options_.loss->weight(iterate.residual(row) / std::sqrt(iterate.R(row))))
              : 1;
  }

  /// The noise estimate, from the posterior's points. [Sarkka2013, algorithm 2; with weights]
  template <class Residual, class Function, class Difference>
  bool learnNoise(Iterate& iterate, const VariationalNoise<M>& faded, const Vector<M>& variance,
                  const Vector<M>& present, const Residual& residual, const Function& h,
                  const Difference& difference) const {
    const auto image = points_.template project<M>(iterate.belief, h, difference);
    if (!image) return false;
    iterate.residual = residual(image->mean);
    const Vector<M> squares = iterate.residual.cwiseAbs2() +
                              points_.template secondMoment<M, M>(image->deviations, image->deviations).diagonal();
    reweigh(iterate, variance, present);
    iterate.noise = faded.with(
        squares.cwiseQuotient(variance).cwiseProduct(share(iterate.weights, squares.cwiseQuotient(iterate.R))), present,
        options_.clamp);
    return true;
  }

  Vector<M> share(const Vector<M>& w, const Vector<M>& normalised) const {
    switch (options_.increment) {
      case NoiseIncrement::Raw: return Vector<M>::Ones();
      case NoiseIncrement::Weighted: return w;
      case NoiseIncrement::Pseudo: return w.cwiseAbs2();
      case NoiseIncrement::Consistent: return w.cwiseAbs2() / consistency_;
      case NoiseIncrement::Mixture: break;
    }
    return options_.loss ? Vector<M>(normalised.unaryExpr(&goodShare)) : Vector<M>(Vector<M>::Ones());
  }

  /// The share of a normalised square that is due to good noise, where one reading in ten has ten times the standard
  /// deviation: the expected inverse of the noise's scale. For good noise alone it is 4 % too low on average.
  static double goodShare(double square) {
    constexpr double kOdds = 0.1 / 0.9, kScale = 100;
    const double bad = kOdds / std::sqrt(kScale) * std::exp(0.5 * square * (1 - 1 / kScale));
    return std::isfinite(bad) ? (1 + bad / kScale) / (1 + bad) : 1 / kScale;
  }

  /// Computes the reported covariance (I - K H) P (I - K H)^T + G V G^T. V is the mean square of the readings'
  /// influence, K the gain by its mean slope and G the gain by its mean weight.
  void reportCovariance(const Belief& prior, const Image& image, const Iterate& iterate, const Vector<M>& present,
                        Belief& posterior) const {
    if (!options_.calibrate) {
      posterior.state.covariance = posterior.own;
      return;
    }
    for (int row = 0; row < M; ++row)
      if (present(row) > 0) posterior.influence.learn(row, influenceOf(iterate, row));
    const Matrix<N, M> PHt = points_.template secondMoment<N, M>(image.dX, image.deviations);
    const Matrix<M> HPHt = points_.template secondMoment<M, M>(image.deviations, image.deviations);
    const Matrix<M, N> H = Eigen::LLT<Matrix<N>>(prior.own).solve(PHt).transpose();
    const auto gain = [&](const Vector<M>& weight) {
      return Matrix<N, M>(Innovation<M>(HPHt + Matrix<M>(iterate.R.cwiseQuotient(weight).asDiagonal()))
                              .solve(PHt.transpose())
                              .transpose());
    };
    const auto& mean = posterior.influence;
    const Matrix<N, M> K = gain(mean.slope), G = gain(mean.weight);
    const Matrix<N> left = Matrix<N>::Identity() - K * H;
    const Vector<M> noise = iterate.R.cwiseProduct(mean.square).cwiseQuotient(mean.weight.cwiseAbs2());
    posterior.state.covariance =
        left * prior.state.covariance * left.transpose() + G * noise.asDiagonal() * G.transpose();
    symmetrize(posterior.state.covariance);
  }

  /// The influence of a reading on the mean. It is smaller with an estimated noise, which the reading itself increases.
  Influence influenceOf(const Iterate& iterate, int row) const {
    const double r = iterate.residual(row) / std::sqrt(iterate.R(row));
    const double weight = options_.loss ? options_.peak * options_.loss->weight(r) : 1;
    const double slope = options_.loss ? options_.peak * options_.loss->slope(r) : 1;
    if (!options_.adaptive) return {weight * r, slope, weight};
    const double own = 2 * (1 + options_.trend) * (1 - options_.rho) *
                       share(iterate.weights, iterate.residual.cwiseAbs2().cwiseQuotient(iterate.R))(row);
    return {weight * r, slope - own * weight * r * r, weight};
  }

  static constexpr double kLeastWeight = 1e-9;  // a weight of 0 would make the noise infinite

  Options options_;
  double consistency_;
  Points points_;
};

}  // namespace sas_motion
