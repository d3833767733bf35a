// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/filters/adaptive_cubature_filter.hpp"
#include "sas_motion/systems/usbl/robust_fit.hpp"

namespace sas_motion::usbl {

using CubatureFilter = AdaptiveCubatureFilter<kStates, kChannels>;

/// Everything that decides a calibration beside the pings.
struct Config {
  Mode mode = Mode::DirectionAngles;
  Prior prior;
  FitOptions fit;               ///< of batch, and of the filters' start
  State drift = State::Zero();  ///< standard deviation of the state's change from ping to ping [rad, m]
  double start_window = 60;     ///< filters begin with a robust fit of the pings of this long; 0: with the prior [s]
  double check_window = 300;  ///< a fit of the pings of this long says whether a filter has locked in; 0: none does [s]
  Loss huber{LossKind::Huber};
  double student_t_nu = 3;           ///< degrees of freedom of student_t_vbckf [-]
  double correntropy_bandwidth = 2;  ///< of mc_vbckf [-]
  AdaptiveCubatureOptions cubature;  ///< what all filters have in common
};

/// ckf, vbckf, hckf, hvbckf, student_t_vbckf, mc_vbckf.
const std::vector<std::string>& filterNames();
/// The settings of a filter; nothing for an unknown name.
std::optional<AdaptiveCubatureOptions> filterOptions(const std::string& name, const Config& config);

/// One filter over the pings of a calibration, guarded against what a first outlier or wrongly stated noise would do to
/// it: it starts from a robust fit of the first minute, and where later pings, fitted on their own, contradict it, it
/// has locked in and starts from their fit.
class Calibrator {
 public:
  using Report = Update<CubatureFilter::Belief, kChannels>;

  /// Throws std::invalid_argument for an unknown filter.
  Calibrator(const std::string& filter, const Config& config);

  /// Takes a ping with a reading of direction angles. Pings must come in the order of time. The report is Invalid while
  /// the start waits, for a ping without any usable channel, and where the filter fails.
  Report process(const Ping& ping);

  bool started() const { return started_; }
  const Gaussian<kStates>& belief() const { return belief_.state; }
  /// Of each channel's noise, over the stated variance, as the filter has it.
  Vector<kChannels> noiseFactor() const;
  /// How often it was found to have locked in.
  int lockIns() const { return lock_ins_; }

 private:
  Problem window(double seconds) const;
  void startFrom(const Problem& problem, const Fit& fit);
  void checkLockIn();

  Config config_;
  AdaptiveCubatureOptions options_;
  Model model_;
  CubatureFilter filter_;
  CubatureFilter::Belief belief_;
  std::deque<Ping> recent_;  // in the model's mode, as long as the longest window
  Stamp first_ = 0, checked_ = 0;
  bool started_ = false;
  int lock_ins_ = 0;
};

}  // namespace sas_motion::usbl
