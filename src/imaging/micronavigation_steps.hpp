// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "sas_motion/imaging/micronavigation.hpp"

namespace sas_motion::imaging {

using Complex = std::complex<double>;

/// The predicted poses of two pings and the straight track between them, to which their echoes are moved. Ranges count
/// from the track [m].
struct PingPair {
  std::array<PingPose, 2> poses;
  Eigen::Matrix3d C_local_body;                   ///< half-way between the two attitudes
  Eigen::Vector3d origin, forward, across, down;  ///< of the track: middle of all phase centres, and its axes; local
  double bottom = 0;                              ///< height of the bottom [m]
  std::vector<EchoPath> paths;                    ///< of the first ping's receivers, then of the second's
  double sound_speed = 0;                         ///< [m/s]

  PingPair(const SonarDescription& sonar, const PingPose& first, const PingPose& second,
           const MicronavigationOptions& options);

  /// Unit vector from the track to the bottom, at this sine of the angle forward of broadside; local.
  Eigen::Vector3d sight(double range, double along, double sine = 0) const;
  /// Sine of the angle forward of broadside of the middle of a channel's beam.
  double beamSine(std::size_t channel, const Eigen::Vector3d& sight) const {
    return -paths[channel].forward.dot(sight);
  }
  /// Half a channel's path by the bottom at this range and sine from the channel's place on the track [m].
  double halfPath(std::size_t channel, double range, double sine) const;
  /// First derivative and half the second derivative of half a channel's path over the sine [m].
  struct PathShape {
    double slope = 0, curvature = 0;
  };
  PathShape shape(std::size_t channel, double range, double sine) const;
  /// Place along the track of a channel's phase centre at half the echo's delay [m].
  double along(std::size_t channel, double range) const;
  /// From the first ping's phase centre to the second's, at the delay of this range; on the track's axes [m].
  Eigen::Vector3d displacement(double range) const;
};

/// The echoes of both pings on the straight track: channels x samples, at ranges first_range + n * range_step.
struct AlignedLines {
  double first_range = 0, range_step = 0;  ///< [m]
  int samples = 0;
  std::vector<std::vector<Complex>> channels;

  double range(double sample) const { return first_range + sample * range_step; }
};

/// Moves each echo from its predicted path to the track by delay and carrier phase; exact at broadside.
AlignedLines align(const EchoLines& lines, std::size_t first_line, const SonarDescription& sonar, const PingPair& pair);

constexpr int kCoherentSamples = 128;  ///< samples that are summed with their phases

/// Correction of the predicted displacement from the envelopes, without the carrier's phase.
struct CoarseDisplacement {
  double along = 0;      ///< forward [m]
  double sight = 0;      ///< outwards [m]
  double coherence = 0;  ///< at the best lag of elements and ranges [-]
  int lag = 0;           ///< elements between the paired phase centres of the two pings
};

/// Finds the peak of the coherence over the lags of elements and ranges, by parabolas about the largest values.
CoarseDisplacement searchDisplacement(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                                      const MicronavigationOptions& options);

/// Correction of the second ping's place, by least squares over the envelope's shift in each block of range, on the
/// track's axes [m].
Eigen::Vector3d envelopeDisplacement(const AlignedLines& lines, const PingPair& pair, int lag);

/// Coherence of the speckle at two phase centres, over their distance along track [m]: the Fourier transform of the
/// beam's power, averaged over the band.
class BeamCoherence {
 public:
  explicit BeamCoherence(const SonarDescription& sonar);
  double at(double distance) const { return read(coherence_, distance); }
  /// The same transform of the power times the squared sine of the angle from broadside.
  double squaredSine(double distance) const { return read(squares_, distance); }
  /// Standard deviation of the sine of the angle from broadside, weighted by power.
  double spread() const { return spread_; }

 private:
  double read(const std::vector<double>& table, double distance) const;

  double step_ = 0, spread_ = 0;
  std::vector<double> coherence_, squares_;
};

/// Correction of the predicted displacement on the track's axes [m] and of its turn towards the sight [rad], and the
/// coherences of channels.
enum SpeckleParameter { kAlong, kAcross, kDown, kTurn, kBetweenPings, kWithinPing, kSpeckleParameters };
using SpeckleParameters = Eigen::Matrix<double, kSpeckleParameters, 1>;

struct SpeckleEstimate {
  SpeckleParameters parameters;
  Eigen::Matrix<double, kSpeckleParameters, kSpeckleParameters> covariance;
  bool converged = false;
};

/// Maximum likelihood by Fisher scoring of speckle that is circular Gaussian over the channels and independent between
/// resolution cells; the covariance is the Cramer-Rao bound. `start` must be within a quarter of a wavelength.
SpeckleEstimate fitSpeckle(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                           const BeamCoherence& beam, const SpeckleParameters& start);

}  // namespace sas_motion::imaging
