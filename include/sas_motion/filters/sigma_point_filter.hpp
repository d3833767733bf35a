// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/sigma_image.hpp"

namespace sas_motion {

/// A Gaussian filter without Jacobians: it maps points by f and h and fits a Gaussian to their images. With cubature
/// points this is the CKF [Arasaratnam2009], with unscented points the UKF [Julier2004].
///
/// f and h take and return fixed-size vectors. `difference(y, x)` is y - x with angles wrapped; means are formed from
/// differences to the image of the mean, so that points on both sides of +-pi are averaged correctly. Noise is
/// additive, and every update forms new points.
template <int N, int Count>
class SigmaPointFilter {
 public:
  using Belief = Gaussian<N>;

  explicit SigmaPointFilter(const SigmaPoints<N, Count>& points) : points_(points) {}

  /// The belief after x' = f(x) + w, w ~ N(0, Q), or nothing where a covariance is not positive definite or a value not
  /// finite.
  template <class Function, class Difference = PlainDifference>
  std::optional<Belief> predict(const Belief& belief, const Function& f, const Matrix<N>& Q,
                                const Difference& difference = {}) const {
    const auto L = choleskyLower<N>(belief.covariance);
    if (!L) return std::nullopt;
    const auto image = imageOf<N>(points_, belief.mean, Matrix<N, Count>(*L * points_.offsets), f, difference);
    Belief prior{image.mean, Q + secondMoment<N, N>(image.deviations, image.deviations)};
    symmetrize(prior.covariance);
    if (!prior.mean.allFinite() || !choleskyLower<N>(prior.covariance)) return std::nullopt;
    return prior;
  }

  template <int M>
  using Image = SigmaImage<N, M, Count>;

  /// Maps the prior's points by h. Returns nothing where the prior's covariance is not positive definite.
  template <int M, class Function, class Difference = PlainDifference>
  std::optional<Image<M>> project(const Belief& prior, const Function& h, const Difference& difference = {}) const {
    const auto L = choleskyLower<N>(prior.covariance);
    if (!L) return std::nullopt;
    return imageOf<M>(points_, prior.mean, Matrix<N, Count>(*L * points_.offsets), h, difference);
  }

  /// Fuses an innovation, z less the image's mean, with noise covariance R. The result holds the innovation, its S and
  /// NIS.
  template <int M>
  Update<Belief, M> condition(const Belief& prior, const Image<M>& image, const Vector<M>& innovation,
                              const Matrix<M>& R) const {
    Update<Belief, M> result;
    result.belief = prior;
    result.verdict = Verdict::Invalid;
    if (!positiveDefinite<M>(R)) return result;
    result.innovation = innovation;
    result.S = R + secondMoment<M, M>(image.deviations, image.deviations);
    const Innovation<M> S(result.S);
    result.nis = innovation.dot(S.solve(innovation));
    if (!S.valid() || !std::isfinite(result.nis)) return result;

    const Matrix<N, M> K = S.solve(secondMoment<M, N>(image.deviations, image.dX)).transpose();
    // P - K S K^T as a sum of squares, like Joseph's form of a linear h. With weights that are not negative it stays
    // positive semidefinite.
    const Matrix<N, Count> residuals = image.dX - K * image.deviations;
    Belief posterior{prior.mean + K * innovation, secondMoment<N, N>(residuals, residuals) + K * R * K.transpose()};
    symmetrize(posterior.covariance);
    if (!posterior.mean.allFinite() || !choleskyLower<N>(posterior.covariance)) return result;
    result.belief = posterior;
    result.verdict = Verdict::Accepted;
    return result;
  }

  /// The belief after reading z = h(x) + v, v ~ N(0, R). The innovation is z less the mean of h over the prior, not h
  /// of its mean.
  template <int M, class Function, class Difference = PlainDifference>
  Update<Belief, M> update(const Belief& prior, const Vector<M>& z, const Function& h, const Matrix<M>& R,
                           const Difference& difference = {}) const {
    return projectAndCondition<M>(*this, prior, z, h, R, difference);
  }

  /// The weighted sum of products a b^T over the points.
  template <int A, int B>
  Matrix<A, B> secondMoment(const Matrix<A, Count>& a, const Matrix<B, Count>& b) const {
    return a * points_.covariance_weights.asDiagonal() * b.transpose();
  }

 private:
  SigmaPoints<N, Count> points_;
};

template <int N>
using CubatureKalmanFilter = SigmaPointFilter<N, 2 * N>;
template <int N>
using UnscentedKalmanFilter = SigmaPointFilter<N, 2 * N + 1>;

}  // namespace sas_motion
