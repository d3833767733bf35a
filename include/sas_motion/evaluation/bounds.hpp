// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/factorization.hpp"

namespace sas_motion {

/// The posterior Cramer-Rao bound of filtering: no estimator's mean square error is below covariance(), the inverse of
/// the information
///     J_{k+1} = D22 - D21 (J_k + D11)^{-1} D12,   D11 = E[F^T Q^{-1} F],  D12 = -E[F^T Q^{-1}],  D22 = E[Q^{-1}] +
///     E[H^T R^{-1} H]
/// with expectations over truths [Tichavsky1998, eq 21, 34 to 36]. Non-Gaussian noise has Q and R over its information
/// factor.
///
/// Where all truths have the same F and Q this is (Q + F J^{-1} F^T)^{-1}, which also holds for a singular Q. Elsewhere
/// the new J is read off a QR factorization, without the differences of large numbers above, and Q must be positive
/// definite. A constant parameter (F = I, Q = 0) keeps its information: the ordinary bound.
template <int N>
class PosteriorBound {
 public:
  /// Begins with what is known before: the inverse of the prior covariance, or zero.
  explicit PosteriorBound(const Matrix<N>& information) : J_(information) {}

  /// One step of time, linearised at each truth; the process noise has `factor` times the information of a Gaussian's.
  /// Throws std::invalid_argument where there is no truth or no answer.
  void step(const std::vector<Transition<N>>& truths, double factor = 1) {
    if (truths.empty()) throw std::invalid_argument("PosteriorBound: a step needs at least one truth");
    const Transition<N>& first = truths.front();
    const bool same = std::all_of(truths.begin(), truths.end(),
                                  [&](const Transition<N>& t) { return t.F == first.F && t.Q == first.Q; });
    if (same && first.F.isIdentity(0) && first.Q.isZero(0)) return;
    const Eigen::LLT<Matrix<N>> llt(J_);
    if (same && llt.info() == Eigen::Success)
      J_ = inverse(first.Q / factor + first.F * llt.solve(first.F.transpose()));
    else
      stepByQr(truths, factor);
    symmetrize(J_);
  }

  /// One measurement, linearised at each truth. `factors` are, for each truth, the information of each row over that of
  /// a Gaussian with its R; none for 1. R is diagonal.
  template <int M>
  void measurement(const std::vector<LinearMeasurement<N, M>>& truths, const std::vector<Vector<M>>& factors = {}) {
    Matrix<N> sum = Matrix<N>::Zero();
    for (std::size_t i = 0; i < truths.size(); ++i) {
      Vector<M> information = truths[i].R.diagonal().cwiseInverse();
      if (!factors.empty()) information = information.cwiseProduct(factors[i]);
      sum += truths[i].H.transpose() * information.asDiagonal() * truths[i].H;
    }
    if (!truths.empty()) J_ += sum / static_cast<double>(truths.size());
    symmetrize(J_);
  }

  const Matrix<N>& information() const { return J_; }
  /// The bound on the covariance; nothing while there is no information on some state.
  std::optional<Matrix<N>> covariance() const {
    const Eigen::LLT<Matrix<N>> llt(J_);
    if (llt.info() != Eigen::Success) return std::nullopt;
    return Matrix<N>(llt.solve(Matrix<N>::Identity()));
  }

 private:
  static Matrix<N> inverse(const Matrix<N>& A) {
    const Eigen::LLT<Matrix<N>> llt(A);
    if (llt.info() != Eigen::Success)
      throw std::invalid_argument("PosteriorBound: Q + F J^{-1} F^T is not positive definite");
    return llt.solve(Matrix<N>::Identity());
  }

  /// One step in square-root form, by QR. The rows are [U, 0], where J = U^T U, and for each truth [-W F, W], where
  /// W^T W = factor Q^{-1} / (number of truths). Their R has the last block R22, and the new information is
  /// R22^T R22 = D22 - D21 (J + D11)^{-1} D12.
  void stepByQr(const std::vector<Transition<N>>& truths, double factor) {
    const Eigen::Index count = static_cast<Eigen::Index>(truths.size());
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(N * (count + 1), Eigen::Index{2} * N);
    const Eigen::SelfAdjointEigenSolver<Matrix<N>> eigen(J_);
    stacked.template topLeftCorner<N, N>() =
        eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
    const double share = std::sqrt(factor / static_cast<double>(count));
    for (Eigen::Index i = 0; i < count; ++i) {
      const Transition<N>& truth = truths[static_cast<std::size_t>(i)];
      const Eigen::LLT<Matrix<N>> llt(truth.Q);
      if (llt.info() != Eigen::Success)
        throw std::invalid_argument("PosteriorBound: Q must be positive definite where truths differ");
      stacked.template block<N, N>(N * (i + 1), 0) = -share * llt.matrixL().solve(truth.F);
      stacked.template block<N, N>(N * (i + 1), N) = share * llt.matrixL().solve(Matrix<N>::Identity());
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked);
    const Matrix<N> R22 = qr.matrixQR().template block<N, N>(N, N).template triangularView<Eigen::Upper>();
    J_ = R22.transpose() * R22;
  }

  Matrix<N> J_;
};

/// Means of the bound over the scored times of runs with different side information (a genie's, or which readings are
/// missing).
///
/// Given the side information of a run, J^{-1} bounds the mean square error of all runs that have the same (J with
/// expectations over truths), so the mean of J^{-1} over runs bounds that of all runs. The inverse of the mean J is a
/// bound too, but a lower one: (E J)^{-1} <= E J^{-1}.
template <int N>
class MeanBound {
 public:
  /// At one scored time of one run.
  void add(const PosteriorBound<N>& bound) {
    const auto covariance = bound.covariance();
    known_ &= covariance.has_value();
    if (covariance) sum_ += covariance->diagonal();
    ++count_;
  }

  /// The bound on the root mean square of the norm of these states' errors; nothing where one has none.
  std::optional<double> rmse(const std::vector<int>& states) const {
    double square = 0;
    for (const int state : states) square += sum_(state) / static_cast<double>(count_);
    return known_ && count_ > 0 ? std::optional<double>(std::sqrt(square)) : std::nullopt;
  }
  /// rmse() of each named group of states; empty where there is no information on some state.
  std::vector<std::pair<std::string, double>> rmses(
      const std::vector<std::pair<std::string, std::vector<int>>>& groups) const {
    std::vector<std::pair<std::string, double>> bounds;
    for (const auto& [name, states] : groups) {
      const auto bound = rmse(states);
      if (!bound) return {};
      bounds.emplace_back(name, *bound);
    }
    return bounds;
  }

 private:
  Vector<N> sum_ = Vector<N>::Zero();
  std::size_t count_ = 0;
  bool known_ = true;
};

}  // namespace sas_motion
