// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
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

/// A calibration as one least-squares problem over x for every solver, with a rho for each channel of each ping:
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

struct FitOptions {
  Loss loss{LossKind::Huber};
  bool estimate_scale = true;  ///< of each channel's noise, by the median absolute residual
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< relative fall of the cost at which iterations stop [-]
};

/// Minimises the problem's cost from a starting point, without a change of the scale.
using Solver = std::function<Fit(const Problem& problem, const FitOptions& options, const Unknowns& start)>;

/// Iterated re-weighting: Levenberg-Marquardt on the weighted normal equations. The covariance is that of the readings'
/// influence, A^{-1} B A^{-1} with A = sum psi' H^T R^{-1} H and B = sum psi^2 H^T R^{-1} H, and the prior in both.
/// [Huber1981, 7.6]
Fit solveIteratively(const Problem& problem, const FitOptions& options, const Unknowns& start);

/// The covariance of a solution, as above.
Matrix<kUnknowns> influenceCovariance(const Problem& problem, const Loss& loss, const Unknowns& x);
/// The loss's weight of every channel; 0 where it is absent.
std::vector<Vector<kChannels>> weightsAt(const Problem& problem, const Loss& loss, const Unknowns& x);

/// Solves from the prior's mean and estimates the noise's scale, in turns until neither moves. Redescending losses
/// begin from Huber's solution. A channel with too few readings keeps its stated noise.
Fit fit(Problem problem, const FitOptions& options, const Solver& solve = solveIteratively);

/// Calibrates by all pings at once, from the prior's mean, with the noise's scale estimated.
using Fitter = std::function<Fit(const Problem& problem, const FitOptions& options)>;

/// Makes the fitter of a name; empty for an unknown one.
using FitterFactory = std::function<Fitter(const std::string& name)>;

/// The fitter batch without a factor graph; empty for another name.
inline Fitter nativeFitter(const std::string& name) {
  if (name != "batch") return {};
  return [](const Problem& problem, const FitOptions& options) { return fit(problem, options); };
}

}  // namespace sas_motion::usbl
