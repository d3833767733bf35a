// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/problem.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kWellKnown = 0.2;   // of the prior's sigma: larger sigmas of the pings mean not observable
constexpr double kNoticeable = 0.3;  // least component of the weak direction that the verdict names

const char* plainName(int unknown) {
  static const std::array<const char*, kStates> names{"pitch mounting angle",   "roll mounting angle",
                                                      "heading mounting angle", "athwartships lever arm",
                                                      "fore-and-aft lever arm", "vertical lever arm"};
  return names[unknown];
}

std::string list(std::vector<std::string> names) {
  if (names.size() < 2) return names.empty() ? "" : names[0];
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// The unknowns with a noticeable share in the weak direction, the largest first.
std::string weakUnknowns(const Observability& result) {
  std::vector<std::size_t> order(result.weak_direction.size());
  std::iota(order.begin(), order.end(), 0);
  const auto share = [&](std::size_t i) { return std::abs(result.weak_direction[i]); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
  std::vector<std::string> names;
  for (const auto i : order)
    if (share(i) > kNoticeable) names.push_back(plainName(result.unknowns[i]));
  return list(names);
}

std::string verdictOf(const Observability& result) {
  if (result.observable) return "every unknown is seen";
  const std::string what = weakUnknowns(result);
  const bool several = what.find(" and ") != std::string::npos;
  return fmt::format(
      "not observable: {} pings on this track cannot {} {}; what is given for {} rests on the prior; sail a "
      "figure-eight over the transponder, crossing lines or a circle beside it",
      result.pings, several ? "separate" : "tell", what, several ? "them" : "it");
}

/// The pings' information on mounting and lever arm in units of the prior's sigmas. The other unknowns are eliminated,
/// with their prior, which comes from a survey or a probe.
Matrix<kStates> knownOfMounting(const Matrix<kUnknowns>& data, const Prior& prior) {
  constexpr int kOthers = kUnknowns - kStates;
  const Matrix<kUnknowns> scaled = prior.sigma.asDiagonal() * data * prior.sigma.asDiagonal();
  const Matrix<kOthers> others = scaled.bottomRightCorner<kOthers, kOthers>() + Matrix<kOthers>::Identity();
  const Matrix<kStates, kOthers> shared = scaled.topRightCorner<kStates, kOthers>();
  return scaled.topLeftCorner<kStates, kStates>() - shared * others.llt().solve(shared.transpose());
}

}  // namespace

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

Observability observability(const Matrix<kUnknowns>& data, const Prior& prior, std::size_t pings) {
  Observability result;
  result.pings = pings;
  for (int i = 0; i < kUnknowns; ++i)
    if (prior.estimated[i]) result.unknowns.push_back(i);
  const auto n =
      static_cast<Eigen::Index>(std::count(prior.estimated.begin(), prior.estimated.begin() + kStates, true));
  result.bound = covarianceFrom(data, prior).diagonal().cwiseSqrt();
  if (n == 0) return result;
  const Matrix<kStates> known = knownOfMounting(data, prior);
  Eigen::MatrixXd scaled(n, n);
  for (Eigen::Index row = 0; row < n; ++row)
    for (Eigen::Index col = 0; col < n; ++col) scaled(row, col) = known(result.unknowns[row], result.unknowns[col]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  for (Eigen::Index i = n - 1; i >= 0; --i) result.singular_values.push_back(std::max(0.0, eigen.eigenvalues()(i)));
  const Eigen::VectorXd weak =
      eigen.eigenvectors().col(0).cwiseProduct(scaled.diagonal().cwiseMax(1e-12).cwiseSqrt()).normalized();
  result.weak_direction.assign(weak.data(), weak.data() + n);
  result.weak_sigma = 1 / std::sqrt(result.singular_values.back());
  result.observable = result.weak_sigma < kWellKnown;
  result.verdict = verdictOf(result);
  return result;
}

Observability observability(const Problem& problem, const Unknowns& x, const Vector<kChannels>& factor) {
  return observability(information(problem, x, factor), problem.prior, problem.pings.size());
}

}  // namespace sas_motion::usbl
