// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/filters/adaptive_cubature_filter.hpp"
#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

using CubatureFilter = AdaptiveCubatureFilter<kStates, kChannels>;

/// Settings of a calibration.
struct Config {
  Mode mode = Mode::DirectionAngles;
  Prior prior;
  FitOptions fit;               ///< of batch and of the filters' start
  State drift = State::Zero();  ///< standard deviation of the state's change from ping to ping [rad, m]
  double start_window = 60;     ///< of the robust fit that filters start from; 0: they start from the prior [s]
  double check_window = 300;    ///< of the fits that check a filter for lock-in; 0: no check [s]
  Loss huber{LossKind::Huber};
  double student_t_nu = 3;           ///< degrees of freedom of student_t_vbckf [-]
  double correntropy_bandwidth = 2;  ///< of mc_vbckf [-]
  AdaptiveCubatureOptions cubature;  ///< of all filters
};
/// Reads mode and the sections prior, estimate, fit and filters. Throws ConfigError.
void readConfig(YamlSection& yaml, Config& config);

/// ckf, vbckf, hckf, hvbckf, student_t_vbckf, mc_vbckf.
const std::vector<std::string>& filterNames();
/// The settings of a filter; nothing for an unknown name.
std::optional<AdaptiveCubatureOptions> filterOptions(const std::string& name, const Config& config);

/// One filter over the pings of a calibration, guarded against an outlier at the start and wrongly stated noise: it
/// starts from a robust fit of the first minute, and again from a fit of the latest pings where that contradicts it
/// (lock-in).
class Calibrator {
 public:
  using Report = Update<CubatureFilter::Belief, kChannels>;

  /// Throws std::invalid_argument for an unknown filter.
  Calibrator(const std::string& filter, const Config& config);

  /// Takes a ping with a reading of direction angles, in the order of time. The report is Invalid before the start, for
  /// a ping without a usable channel, and where the filter fails.
  Report process(const Ping& ping);

  bool started() const { return started_; }
  const Gaussian<kStates>& belief() const { return belief_.state; }
  /// The estimated variance of each channel's noise over the stated one.
  Vector<kChannels> noiseFactor() const;
  /// Number of lock-ins found.
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
