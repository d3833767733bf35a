// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/problem.hpp"

#include <Eigen/Cholesky>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::usbl {

Unknowns Prior::defaultSigma() {
  Unknowns sigma;
  sigma << Vector<3>::Constant(3 * kRadPerDeg), Vector<3>::Constant(1), Vector<3>::Constant(0.1), 3e-3;
  return sigma;
}

Vector<kChannels> normalisedResidual(const Problem& problem, const Ping& ping, const Unknowns& x) {
  Vector<kChannels> residual = problem.model.difference(ping.reading.value, problem.model.predict(x, ping));
  for (int i = 0; i < kChannels; ++i)
    residual(i) = ping.reading.has(i) ? residual(i) / (problem.scale(i) * std::sqrt(ping.reading.variance(i))) : 0;
  return residual;
}

double cost(const Problem& problem, const Loss& loss, const Unknowns& x) {
  double sum = 0;
  for (int i = 0; i < kUnknowns; ++i)
    if (problem.prior.estimated[i]) sum += 0.5 * std::pow((x(i) - problem.prior.mean(i)) / problem.prior.sigma(i), 2);
  for (const auto& ping : problem.pings) {
    const Vector<kChannels> residual = normalisedResidual(problem, ping, x);
    for (int i = 0; i < kChannels; ++i) sum += loss.rho(residual(i));
  }
  return sum;
}

Matrix<kUnknowns> information(const Problem& problem, const Unknowns& x, const Vector<kChannels>& factor) {
  Matrix<kUnknowns> sum = Matrix<kUnknowns>::Zero();
  for (const auto& ping : problem.pings) {
    const auto H = problem.model.jacobian(x, ping);
    for (int i = 0; i < kChannels; ++i)
      if (ping.reading.has(i))
        sum += H.row(i).transpose() * H.row(i) *
               (factor(i) / (problem.scale(i) * problem.scale(i) * ping.reading.variance(i)));
  }
  for (int i = 0; i < kUnknowns; ++i)
    if (!problem.prior.estimated[i]) sum.row(i).setZero(), sum.col(i).setZero();
  return sum;
}

Matrix<kUnknowns> covarianceFrom(const Matrix<kUnknowns>& data, const Prior& prior) {
  // In units of the prior's sigmas the prior's information is the identity.
  const Matrix<kUnknowns> scaled =
      prior.sigma.asDiagonal() * data * prior.sigma.asDiagonal() + Matrix<kUnknowns>::Identity();
  Matrix<kUnknowns> covariance =
      prior.sigma.asDiagonal() * scaled.llt().solve(Matrix<kUnknowns>::Identity()) * prior.sigma.asDiagonal();
  for (int i = 0; i < kUnknowns; ++i)
    if (!prior.estimated[i]) covariance.row(i).setZero(), covariance.col(i).setZero();
  return covariance;
}

}  // namespace sas_motion::usbl
