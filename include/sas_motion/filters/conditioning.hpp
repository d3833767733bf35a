// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/filters/update.hpp"
#include "sas_motion/math/factorization.hpp"

namespace sas_motion {

/// The inverse of a small symmetric positive definite matrix S: a division for 1x1, a checked Cholesky factorization
/// for larger ones.
template <int M>
class Innovation {
 public:
  explicit Innovation(const Matrix<M>& S) : llt_(S) {}
  bool valid() const { return llt_.info() == Eigen::Success; }
  template <class Rhs>
  auto solve(const Rhs& rhs) const {
    return llt_.solve(rhs).eval();
  }

 private:
  Eigen::LLT<Matrix<M>> llt_;
};

template <>
class Innovation<1> {
 public:
  explicit Innovation(const Matrix<1>& S) : valid_(S(0, 0) > 0 && std::isfinite(S(0, 0))), inverse_(1.0 / S(0, 0)) {}
  bool valid() const { return valid_; }
  template <class Rhs>
  auto solve(const Rhs& rhs) const {
    return (rhs * inverse_).eval();
  }

 private:
  bool valid_;
  double inverse_;
};

/// Whether R is a valid noise covariance. S can be positive definite although a variance in R is negative.
template <int M>
bool positiveDefinite(const Matrix<M>& R) {
  return M == 1 ? R(0, 0) > 0 : Eigen::LLT<Matrix<M>>(R).info() == Eigen::Success;
}

/// P H^T and H P H^T of a prior, which all iterations of an update share.
template <int N, int M>
struct Projection {
  Projection(const Matrix<N>& P, const Matrix<M, N>& H) : PHt(P * H.transpose()), HPHt(H * PHt) {}
  Matrix<N, M> PHt;
  Matrix<M> HPHt;
};

/// x^+ and P^+ = (I - K H) P (I - K H)^T + K R K^T (Joseph) for S = H P H^T + R, written as rank-M updates of P so that
/// no N x N product is formed.
template <int N, int M>
Gaussian<N> condition(const Gaussian<N>& prior, const Projection<N, M>& projection, const Matrix<M>& R,
                      const Innovation<M>& S, const Vector<M>& innovation) {
  const Matrix<N, M> K = S.solve(projection.PHt.transpose()).transpose();
  Gaussian<N> posterior;
  posterior.mean.noalias() = prior.mean + K * innovation;
  Matrix<N> IKH_P = prior.covariance;
  IKH_P.noalias() -= K * projection.PHt.transpose();
  const Matrix<N, M> right = projection.PHt - K * projection.HPHt - K * R;
  posterior.covariance = IKH_P;
  posterior.covariance.noalias() -= right * K.transpose();
  symmetrize(posterior.covariance);
  return posterior;
}

/// The result of an update before z is fused: the prior with innovation, S and NIS. The verdict is Invalid where z
/// cannot be used.
template <class Belief, int N, int M>
Update<Belief, M> examine(const Belief& prior, const LinearMeasurement<N, M>& z) {
  Update<Belief, M> result;
  result.belief = prior;
  result.innovation = z.innovation;
  result.S = Projection<N, M>(gaussian(prior).covariance, z.H).HPHt + z.R;
  const Innovation<M> S(result.S);
  result.nis = z.innovation.dot(S.solve(z.innovation));
  if (!S.valid() || !positiveDefinite(z.R) || !std::isfinite(result.nis)) result.verdict = Verdict::Invalid;
  return result;
}

/// The covariance that increases h^T P h by `variance` in two ways: along with the correlated states, for a drift, and
/// in row h alone, for a jump. With the first alone a jump of the position would become a current of tens of metres a
/// second. Zero where `variance` is not positive.
template <int N>
Matrix<N> widening(const Matrix<N>& P, const Vector<N>& h, double variance) {
  const Vector<N> drift = P * h / h.dot(P * h), jump = h / h.squaredNorm();
  if (!(variance > 0) || !drift.allFinite()) return Matrix<N>::Zero();
  return variance * (drift * drift.transpose() + jump * jump.transpose());
}

}  // namespace sas_motion
