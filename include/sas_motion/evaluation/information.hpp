// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// How much readings with a noise law tell of what they measure: their Fisher information over 1 / sigma^2 of the good
/// noise.
///
/// Independent draws (contaminated, Student's t, multipath, quantised) count by the integral of their density's score
/// squared. What lasts (burst, step, ramp, frozen, correlated, varying) gets a genie: it says which readings are bad,
/// and they count nothing, or what the correlated part and the present sigma are. The bound is then lower than what can
/// be reached. Missing readings count nothing either, but that is no secret.
///
/// What a genie says differs from run to run: see MeanBound. (Averaging the information of all runs in each step
/// instead is lower by 13 % where one second in twenty has ten times the process noise.)
class MeasurementInformation {
 public:
  /// Throws std::invalid_argument for two multipath laws in one list.
  explicit MeasurementInformation(const NoiseMix& mix);

  /// Of a reading that no genie calls bad, at sigma 1.
  double factor() const { return factor_; }
  bool genie() const { return genie_; }
  /// Of one reading, from what the simulator says of it: the told variance and the time since the start [s].
  double of(double told_variance, double time) const;

 private:
  std::vector<NoiseLaw> varying_;
  bool spells_ = false;  ///< some readings are called bad
  bool genie_ = false;
  double factor_ = 1;
};

/// The same of process noise: over Q^{-1}.
struct ProcessInformation {
  double factor = 1;
  bool genie = false;  ///< told how large the noise is in each step: multiply Q by it
};

/// Of `states` states over a step of `step` seconds. Contamination that is drawn for each state and step, or once a
/// step for all, counts by its density; what lasts for longer gets a genie.
ProcessInformation processInformation(const NoiseMix& mix, int states, double step);

}  // namespace sas_motion
