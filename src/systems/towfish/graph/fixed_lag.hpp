// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>

#include "sas_motion/systems/towfish/clock_guard.hpp"

namespace sas_motion::towfish {

/// The same graph over a sliding window, live: GTSAM's incremental fixed-lag smoother. A node is settled, and put out,
/// when it leaves the window. Measurements wait `reorder` seconds for older ones, so that nodes are created in time
/// order; later ones are stale. When the clock is set, or after a long gap, it starts anew.
class FixedLagSmoother final : public Estimator {
 public:
  explicit FixedLagSmoother(const Config& config);
  ~FixedLagSmoother() override;

  void process(const Measurement& z, Output& output) override;
  void finish(Output& output) override;
  std::optional<Estimate> current() const override;
  std::optional<Estimate> at(Stamp stamp) const override;
  const char* setState(const Estimate& state, Output& output) override;
  void configure(const Config& config) override;
  void reset() override;

  /// How often the solver failed and was rebuilt from its last good state.
  int rebuilds() const { return rebuilds_; }

 private:
  struct Window;

  void startAnew(Output& output);
  void insert(const Measurement& z, Output& output);
  void settleAll(Output& output);
  void forget();
  void release(Stamp until, Output& output);
  bool start(Stamp until, Output& output);
  void solve(Output& output);
  void rebuild(Output& output);
  void settle(Stamp until, Output& output);

  Config config_;
  ClockGuard clock_;
  double start_window_;  // [s]
  std::unique_ptr<Window> window_;
  std::deque<Measurement> waiting_;  // sorted, not yet older than the reorder time
  std::optional<Stamp> released_;    // nodes exist up to here
  int rebuilds_ = 0;
};

}  // namespace sas_motion::towfish
