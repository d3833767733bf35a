// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// The Fisher information of readings with a noise law, over 1 / sigma^2 of the good noise.
///
/// Independent draws (contaminated, Student's t, multipath, quantised) count by the integral of their density's score
/// squared. For noise that lasts (burst, step, ramp, frozen, correlated, varying) the bound assumes side information, a
/// genie: which readings are bad, and these have no information; or the correlated part and the present sigma. The
/// bound is then lower than any estimator can reach. Missing readings have no information either, which every estimator
/// knows.
///
/// The side information differs from run to run: see MeanBound. (Averaging the information of all runs in each step
/// instead is lower by 13 % where one second in twenty has ten times the process noise.)
class MeasurementInformation {
 public:
  /// Throws std::invalid_argument for two multipath laws in one list.
  explicit MeasurementInformation(const NoiseMix& mix);

  /// Information of a reading of sigma 1, where nothing is known of its own noise but the law.
  double factor() const { return factor_; }
  /// Whether the bound assumes side information.
  bool genie() const { return genie_; }
  /// Information of one reading, given the variance it was drawn with and the time since the start [s].
  double of(double true_variance, double time) const;

 private:
  std::vector<NoiseLaw> varying_;
  bool spells_ = false;  ///< some readings are called bad
  bool genie_ = false;
  double factor_ = 1;
};

/// The information of process noise over Q^{-1}.
struct ProcessInformation {
  double factor = 1;
  bool genie = false;  ///< the bound assumes that the variance of each step is known: multiply Q by it
};

/// Information of the process noise of so many `states` over a `step` [s]. Contamination drawn anew at each step is
/// counted by its density; of contamination that lasts longer the bound assumes that the variance is known (genie).
ProcessInformation processInformation(const NoiseMix& mix, int states, double step);

}  // namespace sas_motion
