// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

/// A filter's estimate after a ping.
struct TracePoint {
  Stamp stamp = 0;
  State mean = State::Zero();
  State sigma = State::Zero();
};

/// One estimator's result from all pings.
struct Estimated {
  std::string name;
  Unknowns x = Unknowns::Zero();
  Matrix<kUnknowns> covariance = Matrix<kUnknowns>::Zero();
  std::vector<Vector<kChannels>> noise;  ///< sigma of good noise over the stated one, of each ping's channels
  std::vector<TracePoint> trace;         ///< of a filter, from its start on
  int lock_ins = 0;                      ///< number of lock-ins found, each followed by a new start
  std::string failure;                   ///< in plain words; empty where there is none

  Unknowns sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// A channel's residuals at a solution.
struct ChannelStatistics {
  std::size_t count = 0;     ///< pings with the channel
  std::size_t outliers = 0;  ///< of them, residuals beyond kOutlier
  double mean = 0;           ///< of the other residuals [m, rad]
  double rms = 0;            ///< of the other residuals [m, rad]
  double noise = 1;          ///< median over time of the noise's sigma over the stated one [-]
};
/// Squared distance of six states that two consistent answers stay below with a probability of 99 %.
double agreementLimit();
constexpr double kOutlier = 3;  ///< least residual of an outlier, in sigmas of the estimated noise

/// All estimators of a calibration on the same pings, and whether to trust the answer.
struct Comparison {
  Problem problem;                   ///< pings in the mode's readings; the scale is the answer's
  std::vector<Estimated> estimates;  ///< in the order of the names, then batch
  std::size_t answer = 0;            ///< index of the answer
  Observability observability;       ///< at the answer
  double distance = 0;               ///< squared Mahalanobis distance between the answer and batch [-]
  bool agrees = true;                ///< with batch; a filter after lock-in does not
  std::string implausible;           ///< why the readings contradict the answer; empty where they do not
  std::vector<std::string> warnings;
  std::string failure;  ///< set where no estimator gave an answer

  const Estimated& best() const { return estimates[answer]; }
  bool trusted() const { return failure.empty() && implausible.empty() && observability.observable && agrees; }
};

/// Runs filters by name, and always batch, which cannot lock in. The answer is hvbckf's if it runs and no further
/// unknowns are estimated, else batch's. Names that `fitters` does not know must be of filterNames().
Comparison compare(
    const std::vector<Ping>& pings, const Config& config, const std::vector<std::string>& names,
    const FitterFactory& fitters = nativeFitter, const std::function<void()>& progress = [] {});

/// Residuals of a ping over an estimator's noise; 0 where a channel is absent.
Vector<kChannels> whitenedResidual(const Comparison& comparison, const Estimated& estimated, std::size_t ping);
ChannelStatistics channelStatistics(const Comparison& comparison, const Estimated& estimated, int channel);

/// Names of a mode's channels: range, to_starboard, ...
std::array<std::string, kChannels> channelNames(Mode mode);
/// filterNames(), batch and gnc.
std::vector<std::string> estimatorNames();

}  // namespace sas_motion::usbl
