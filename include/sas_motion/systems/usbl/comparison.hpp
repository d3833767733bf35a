// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/fitter.hpp"
#include "sas_motion/systems/usbl/observability.hpp"

namespace sas_motion::usbl {

/// A filter after a ping.
struct TracePoint {
  Stamp stamp = 0;
  State mean = State::Zero();
  State sigma = State::Zero();
};

/// What one estimator made of all pings.
struct Estimated {
  std::string name;
  Unknowns x = Unknowns::Zero();
  Matrix<kUnknowns> covariance = Matrix<kUnknowns>::Zero();
  std::vector<Vector<kChannels>>
      noise;                      ///< of each ping's channels: standard deviation of good noise over the stated one
  std::vector<TracePoint> trace;  ///< from a filter's start on; none of batch
  int lock_ins = 0;               ///< how often it was found to have locked in, and started anew
  std::string failure;            ///< in plain words; empty where there is none

  Unknowns sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// A channel's residuals at a solution.
struct ChannelStatistics {
  std::size_t count = 0;     ///< pings that have it
  std::size_t outliers = 0;  ///< of them beyond kOutlier standard deviations
  double mean = 0;           ///< of the others [m, rad]
  double rms = 0;            ///< of the others [m, rad]
  double noise = 1;          ///< median over time of the noise's standard deviation over the stated one [-]
};
/// Squared distance, of six states, that two honest answers stay below with a probability of 99 %.
double agreementLimit();
constexpr double kOutlier =
    3;  ///< a residual beyond this many standard deviations of the estimated noise is called an outlier

/// All estimators of a calibration on the same pings, and whether their answer may be believed.
struct Comparison {
  Problem problem;                   ///< pings in the mode's readings; the scale is the answer's
  std::vector<Estimated> estimates;  ///< as they were asked for, then batch where it was not
  std::size_t answer = 0;            ///< which of them is the answer
  Observability observability;       ///< at the answer
  double distance = 0;               ///< squared Mahalanobis distance between the answer and batch [-]
  bool agrees = true;                ///< with batch: a filter that has locked in does not
  std::string implausible;  ///< in plain words, why the answer cannot be right although it may be observable; empty
                            ///< where it can
  std::vector<std::string> warnings;
  std::string failure;  ///< no estimator gave an answer

  const Estimated& best() const { return estimates[answer]; }
  bool trusted() const { return failure.empty() && implausible.empty() && observability.observable && agrees; }
};

/// Runs filters by name, and batch, which is always run since it cannot lock in. The answer is hvbckf's where it is
/// among them and no further unknowns are estimated, else batch's. Names that `fitters` does not know must be of
/// filterNames().
Comparison compare(
    const std::vector<Ping>& pings, const Config& config, const std::vector<std::string>& names,
    const FitterFactory& fitters = nativeFitter, const std::function<void()>& progress = [] {});

/// Residuals of a ping over the noise that an estimator saw there; 0 where a channel is absent.
Vector<kChannels> whitenedResidual(const Comparison& comparison, const Estimated& estimated, std::size_t ping);
ChannelStatistics channelStatistics(const Comparison& comparison, const Estimated& estimated, int channel);

/// What a mode's channels are called: range, to_starboard, ...
std::array<std::string, kChannels> channelNames(Mode mode);
/// filterNames(), batch and gnc.
std::vector<std::string> estimatorNames();

}  // namespace sas_motion::usbl
