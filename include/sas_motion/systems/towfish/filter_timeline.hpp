// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "sas_motion/systems/towfish/clock_guard.hpp"
#include "sas_motion/systems/towfish/filter_history.hpp"

namespace sas_motion::towfish {

/// A filter run over a window of history, so that late measurements are fused at their own time. It decides when to
/// start, what comes too late and what is settled. When the clock is set, or after a long gap, it starts anew.
template <class Filter>
class FilterTimeline final : public Estimator {
 public:
  using Make = std::function<Filter(const Config&)>;

  FilterTimeline(Make make, const Config& config);
  /// For one that knows more of the motion than the model.
  FilterTimeline(Make make, const Config& config, Motion motion);

  void process(const Measurement& z, Output& output) override;
  void finish(Output& output) override;
  std::optional<Estimate> current() const override;
  std::optional<Estimate> at(Stamp stamp) const override;
  const char* setState(const Estimate& state, Output& output) override;
  void configure(const Config& config) override;
  void reset() override;

 private:
  using Entry = typename FilterHistory<Filter>::Entry;

  void startAnew(Output& output);
  void insert(const Measurement& z, Output& output);
  void start();
  void settle(Stamp until, Output& output);
  void settleAll(Output& output);
  void giveUpFront(Output& output);
  void forget();

  Make make_;
  Config config_;
  ClockGuard clock_;
  FilterHistory<Filter> history_;
  double start_window_;           // [s]
  std::optional<Stamp> settled_;  // nothing at or before this stamp can change
  Stamp start_stamp_ = 0;         // measurements up to here decided the start
  bool start_settled_ = false;    // the start itself can no longer change
};

}  // namespace sas_motion::towfish
