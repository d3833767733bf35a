// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/robust/loss.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

/// What is known of the unknowns before any ping: mean and standard deviation. Those that are not `estimated` are known
/// to be at their mean.
struct Prior {
  Unknowns mean = Unknowns::Zero();
  Unknowns sigma = defaultSigma();
  std::array<bool, kUnknowns> estimated{true, true, true, true, true, true, false, false, false, false};

  /// 3 degrees, 1 m; 0.1 m of the transponder, 0.3 % of the sound speed.
  static Unknowns defaultSigma();
};

/// A calibration as one least-squares problem, the same for every solver: unknowns x with
///     1/2 |(x - mean) / sigma|^2 + sum rho((z - h(x)) / (scale sqrt(variance)))
/// with one rho for each channel of each ping.
struct Problem {
  Model model;
  Prior prior;
  std::vector<Ping> pings;                              ///< with readings in the model's mode
  Vector<kChannels> scale = Vector<kChannels>::Ones();  ///< of each channel's noise over its stated standard deviation
};

/// (z - h(x)) / (scale sigma) of a ping; 0 where the channel is absent.
Vector<kChannels> normalisedResidual(const Problem& problem, const Ping& ping, const Unknowns& x);

double cost(const Problem& problem, const Loss& loss, const Unknowns& x);

/// What the pings tell of the unknowns by good noise of the problem's scale, linearised at x: sum H^T R^{-1} H, without
/// the prior; rows and columns of what is not estimated are 0. `factor` is the noise's Fisher information over a
/// Gaussian's.
Matrix<kUnknowns> information(const Problem& problem, const Unknowns& x,
                              const Vector<kChannels>& factor = Vector<kChannels>::Ones());

/// The inverse of data and prior information; variances of what is not estimated are 0.
Matrix<kUnknowns> covarianceFrom(const Matrix<kUnknowns>& data, const Prior& prior);

/// What a solver found. Failure is data: `failure` says in plain words what went wrong and is empty otherwise.
struct Fit {
  Unknowns x = Unknowns::Zero();
  Matrix<kUnknowns> covariance = Matrix<kUnknowns>::Zero();  ///< by the influence that the readings have had
  Vector<kChannels> scale = Vector<kChannels>::Ones();
  std::vector<Vector<kChannels>> weights;  ///< of each ping's channels; 0 where absent
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  std::string failure;
};

}  // namespace sas_motion::usbl
