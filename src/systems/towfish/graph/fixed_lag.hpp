// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "sas_motion/systems/towfish/start_finder.hpp"

namespace sas_motion::towfish {

/// The same graph over a sliding window, live: GTSAM's incremental fixed-lag smoother. A node is settled, and put out,
/// when it leaves the window. Its present is a robust Kalman filter's, from the newest node on.
class FixedLagSmoother final : public Estimator {
 public:
  explicit FixedLagSmoother(const Config& config);
  ~FixedLagSmoother() override;

  void process(const Measurement& z, Output& output) override;
  void endStamp(Output& output) override;
  void finish(Output& output) override;
  void startAnew(Output& output) override;
  void setState(const Estimate& state, Output& output) override;
  void configure(const Config& config) override;
  double lag() const override { return config_.fixed_lag.reorder; }
  std::unique_ptr<Estimator> clone() const override;
  std::uint64_t corrections() const override { return corrections_; }

  /// How often the solver failed and was rebuilt from its last good state.
  int rebuilds() const { return rebuilds_; }

 private:
  struct Window;

  void solve(Output& output);
  void rebuild(Output& output);
  void settle(Stamp until, Output& output);

  Config config_;
  StartFinder start_;
  std::unique_ptr<Window> window_;
  std::uint64_t corrections_ = 0;
  int rebuilds_ = 0;
};

}  // namespace sas_motion::towfish
