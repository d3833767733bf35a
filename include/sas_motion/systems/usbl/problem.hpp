// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/robust/loss.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

/// Mean and standard deviation of the unknowns before any ping. Those that are not `estimated` stay at their mean.
struct Prior {
  Unknowns mean = Unknowns::Zero();
  Unknowns sigma = defaultSigma();
  std::array<bool, kUnknowns> estimated{true, true, true, true, true, true, false, false, false, false};

  /// 3 degrees; 1 m of the lever arm, 0.1 m of the transponder; 0.3 % of the range.
  static Unknowns defaultSigma();
};

/// A calibration as one least-squares problem for every solver: minimise over x, with a rho for each channel of each
/// ping,
///     1/2 |(x - mean) / sigma|^2 + sum rho((z - h(x)) / (scale sqrt(variance)))
struct Problem {
  Model model;
  Prior prior;
  std::vector<Ping> pings;                              ///< with readings in the model's mode
  Vector<kChannels> scale = Vector<kChannels>::Ones();  ///< of each channel's noise over the stated sigma
};

/// (z - h(x)) / (scale sigma) of a ping; 0 where the channel is absent.
Vector<kChannels> normalisedResidual(const Problem& problem, const Ping& ping, const Unknowns& x);

double cost(const Problem& problem, const Loss& loss, const Unknowns& x);

/// Information of the pings without the prior, linearised at x: sum H^T R^{-1} H, with zeros for unknowns that are not
/// estimated. `factor` is the noise's Fisher information over a Gaussian's.
Matrix<kUnknowns> information(const Problem& problem, const Unknowns& x,
                              const Vector<kChannels>& factor = Vector<kChannels>::Ones());

/// The inverse of data and prior information, with zeros for unknowns that are not estimated.
Matrix<kUnknowns> covarianceFrom(const Matrix<kUnknowns>& data, const Prior& prior);

/// A solver's result. `failure` is empty or the reason in plain words.
struct Fit {
  Unknowns x = Unknowns::Zero();
  Matrix<kUnknowns> covariance = Matrix<kUnknowns>::Zero();  ///< of the readings' influence
  Vector<kChannels> scale = Vector<kChannels>::Ones();
  std::vector<Vector<kChannels>> weights;  ///< of each ping's channels; 0 where absent
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  std::string failure;
};

/// How well a track determines the unknowns.
struct Observability {
  std::size_t pings = 0;
  std::vector<int> unknowns;  ///< that are estimated, first those of mounting and lever arm
  /// Eigenvalues of the pings' information on mounting and lever arm over that of the prior, largest first [-].
  std::vector<double> singular_values;
  /// Unit vector of the least information, each element over its sigma if the others were known.
  std::vector<double> weak_direction;
  double weak_sigma = 0;  ///< sigma in the weak direction by the pings alone, over the prior's; may be infinite [-]
  /// Cramer-Rao bound on each standard deviation by pings and prior; 0 where not estimated [rad, m, -].
  Unknowns bound = Unknowns::Zero();
  bool observable = false;  ///< the pings determine every direction far better than the prior
  std::string verdict;      ///< in plain words, with advice
};

/// Observability by pings whose information is `data`, without the prior's.
Observability observability(const Matrix<kUnknowns>& data, const Prior& prior, std::size_t pings);

/// Observability of a problem, linearised at x; `factor` as for information().
Observability observability(const Problem& problem, const Unknowns& x,
                            const Vector<kChannels>& factor = Vector<kChannels>::Ones());

}  // namespace sas_motion::usbl
