// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>

#include "imaging/ping_pair.hpp"

namespace sas_motion::imaging {

/// Coherence of the speckle that two phase centres hear, over their distance along track: the Fourier transform of the
/// beam's power, mean over the band.
class BeamCoherence {
 public:
  explicit BeamCoherence(const SonarDescription& sonar);
  double at(double distance) const { return read(coherence_, distance); }  ///< [m]
  double squaredSine(double distance) const {
    return read(squares_, distance);
  }  ///< the same transform of the power times the squared sine of the angle
  double spread() const {
    return spread_;
  }  ///< standard deviation of the sine of the angle from broadside, weighted with power

 private:
  double read(const std::vector<double>& table, double distance) const;

  double step_ = 0, spread_ = 0;
  std::vector<double> coherence_, squares_;
};

/// What the believed displacement lacks, and how alike channels are.
enum SpeckleParameter { kAlong, kAcross, kDown, kTurn, kBetweenPings, kWithinPing, kSpeckleParameters };
using SpeckleParameters = Eigen::Matrix<double, kSpeckleParameters,
                                        1>;  ///< metres on the track's axes, radians towards the sight, coherences

struct SpeckleEstimate {
  SpeckleParameters parameters;
  Eigen::Matrix<double, kSpeckleParameters, kSpeckleParameters> covariance;
  bool converged = false;
};

/// The maximum of the likelihood of speckle, circular Gaussian over the channels and independent from one resolution
/// cell to the next, by Fisher scoring. Its covariance is the Cramer-Rao bound. From `start`, within a quarter of a
/// wavelength.
SpeckleEstimate fitSpeckle(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                           const BeamCoherence& beam, const SpeckleParameters& start);

}  // namespace sas_motion::imaging
