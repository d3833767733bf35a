// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <stdexcept>

#include "sas_motion/filters/sigma_image.hpp"
#include "sas_motion/filters/update.hpp"
#include "sas_motion/math/square_root.hpp"

namespace sas_motion {

/// A sigma-point filter that propagates a root of the covariance: with spherical simplex points the SS-SRUKF, with
/// unscented points the SR-UKF. It is equivalent to SigmaPointFilter and also works with a singular covariance.
/// [Merwe2001]
///
/// Where all weights are at least 0, a prediction is one QR factorization, without downdates, and a downdate that fails
/// in an update can be replaced by a factorization of the sum.
/// Noise is additive and given by a lower triangular root with a diagonal that is not negative. Every update forms new
/// points.
template <int N, int Count, class Points = SigmaPoints<N, Count>>
class SquareRootFilter {
 public:
  using Belief = RootGaussian<N>;
  template <int M>
  using Image = SigmaImage<N, M, Count>;

  /// Throws std::invalid_argument where a weight is negative.
  explicit SquareRootFilter(const Points& points)
      : points_(points), root_weights_(points.covariance_weights.cwiseSqrt()) {
    if (!(points.covariance_weights.minCoeff() >= 0))
      throw std::invalid_argument("a square-root filter needs sigma points without negative weights");
  }

  /// The belief after x' = f(x) + w, w ~ N(0, Q_root Q_root^T), or nothing where a value is not finite.
  template <class Function, class Difference = PlainDifference>
  std::optional<Belief> predict(const Belief& belief, const Function& f, const Matrix<N>& Q_root,
                                const Difference& difference = {}) const {
    const auto image = imageOf<N>(points_, belief.mean, spread(points_, belief.root), f, difference);
    Belief prior{image.mean, Q_root};
    addSquares<N, Count>(prior.root, weighted<N>(image.deviations));
    if (!prior.mean.allFinite() || !prior.root.allFinite()) return std::nullopt;
    return prior;
  }

  /// Maps the prior's points by h. Returns nothing where the prior is not finite.
  template <int M, class Function, class Difference = PlainDifference>
  std::optional<Image<M>> project(const Belief& prior, const Function& h, const Difference& difference = {}) const {
    if (!prior.mean.allFinite() || !prior.root.allFinite()) return std::nullopt;
    return imageOf<M>(points_, prior.mean, spread(points_, prior.root), h, difference);
  }

  /// Fuses an innovation, z less the image's mean, with noise of covariance R_root R_root^T.
  template <int M>
  Update<Belief, M> condition(const Belief& prior, const Image<M>& image, const Vector<M>& innovation,
                              const Matrix<M>& R_root) const {
    Update<Belief, M> result;
    result.belief = prior;
    result.verdict = Verdict::Invalid;
    if (!(R_root.diagonal().minCoeff() > 0)) return result;
    const Matrix<N, Count> dX = weighted<N>(image.dX);
    const Matrix<M, Count> dZ = weighted<M>(image.deviations);
    Matrix<M> S_root = R_root;
    addSquares<M, Count>(S_root, dZ);
    const auto lower = S_root.template triangularView<Eigen::Lower>();
    result.innovation = innovation;
    result.S = S_root * S_root.transpose();
    const Vector<M> whitened = lower.solve(innovation);
    result.nis = whitened.squaredNorm();
    if (!S_root.allFinite() || !std::isfinite(result.nis)) return result;

    const Matrix<M, N> gain = lower.solve(dZ * dX.transpose());  // (K S_root)^T
    Belief posterior{prior.mean + gain.transpose() * whitened, prior.root};
    if (!subtract<M>(posterior.root, gain)) {
      const Matrix<M, N> K = S_root.transpose().template triangularView<Eigen::Upper>().solve(gain);
      posterior.root = residualRoot<M>(dX - K.transpose() * dZ, K.transpose() * R_root);
    }
    if (!posterior.mean.allFinite() || !posterior.root.allFinite()) return result;
    result.belief = posterior;
    result.verdict = Verdict::Accepted;
    return result;
  }

  /// The belief after reading z = h(x) + v, v ~ N(0, R_root R_root^T).
  template <int M, class Function, class Difference = PlainDifference>
  Update<Belief, M> update(const Belief& prior, const Vector<M>& z, const Function& h, const Matrix<M>& R_root,
                           const Difference& difference = {}) const {
    return projectAndCondition<M>(*this, prior, z, h, R_root, difference);
  }

  /// The weighted sum of products a b^T over the points.
  template <int A, int B>
  Matrix<A, B> secondMoment(const Matrix<A, Count>& a, const Matrix<B, Count>& b) const {
    return a * points_.covariance_weights.asDiagonal() * b.transpose();
  }

 private:
  template <int Rows>
  Matrix<Rows, Count> weighted(const Matrix<Rows, Count>& deviations) const {
    return deviations * root_weights_.asDiagonal();
  }

  template <int M>
  static bool subtract(Matrix<N>& root, const Matrix<M, N>& gain) {
    for (int row = 0; row < M; ++row)
      if (!subtractSquare<N>(root, gain.row(row).transpose())) return false;
    return true;
  }

  /// The same posterior as a sum of squares, for where the downdate fails by rounding or a singular covariance.
  template <int M>
  static Matrix<N> residualRoot(const Matrix<N, Count>& residuals, const Matrix<N, M>& noise) {
    Matrix<N> root = Matrix<N>::Zero();
    addSquares<N, Count>(root, residuals);
    addSquares<N, M>(root, noise);
    return root;
  }

  Points points_;
  Vector<Count> root_weights_;
};

template <int N, int Count>
SquareRootFilter(const SigmaPoints<N, Count>&) -> SquareRootFilter<N, Count>;
template <int N>
SquareRootFilter(const SimplexPoints<N>&) -> SquareRootFilter<N, N + 2, SimplexPoints<N>>;

/// The SS-SRUKF. [Li2014]
template <int N>
using SimplexFilter = SquareRootFilter<N, N + 2, SimplexPoints<N>>;

}  // namespace sas_motion
