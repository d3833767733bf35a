// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>

#include "sas_motion/systems/towfish/estimator.hpp"

namespace sas_motion::towfish {

/// Gathers measurements in the order of time until a window of them has a position and a heading to start from.
class StartFinder {
 public:
  explicit StartFinder(const Config& config)
      : options_(config.start), current_sigma_(config.model.current_sigma), window_(options_.window) {}

  void add(const Measurement& z) { gathered_.push_back(z); }
  /// The belief at the first gathered measurement, before it is fused, once a whole window is there. Refuses
  /// measurements whose window has no position or no heading.
  std::optional<Gaussian<kStates>> find(Output& output);
  const std::deque<Measurement>& gathered() const { return gathered_; }
  void clear() { gathered_.clear(); }
  void refuseAll(Output& output);
  /// A shorter window from now on: after a clock was set an answer is waited for.
  void shorten() { window_ = options_.window * kShortened; }

 private:
  static constexpr double kShortened = 0.5;  // of the window

  void refuseFirst(Output& output);

  StartOptions options_;
  double current_sigma_;  // [m/s]
  double window_;         // [s]
  std::deque<Measurement> gathered_;
};

}  // namespace sas_motion::towfish
