// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "imaging/speckle_model.hpp"

namespace sas_motion::imaging {

constexpr int kCoherentSamples = 128;  ///< over which echoes are summed with their phases

/// What the envelopes tell: what the believed displacement lacks, without regard to the carrier's phase.
struct CoarseDisplacement {
  double along = 0;      ///< forward [m]
  double sight = 0;      ///< outwards [m]
  double coherence = 0;  ///< at the best lag of elements and ranges
  int lag = 0;           ///< elements by which the first ping's phase centres are paired
};

/// The peak of the coherence over the lag of elements and of ranges, by parabolas about the largest values.
CoarseDisplacement searchDisplacement(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                                      const MicronavigationOptions& options);

/// How much nearer the second ping is along the line of sight of each stretch of range than believed, from its
/// envelope; fitted by least squares on the track's axes [m].
Eigen::Vector3d envelopeDisplacement(const AlignedLines& lines, const PingPair& pair, int lag);

}  // namespace sas_motion::imaging
