// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "sas_motion/models/held_input.hpp"
#include "sas_motion/pipeline/clock_guard.hpp"

namespace sas_motion::towfish {

/// A filter run over a window of history, so that late measurements are fused at their own time: the state is rewound to just before one
/// and what came after is replayed. When the clock is set, or after a long gap, it starts anew.
template <class Filter>
class FilterTimeline final : public Estimator {
 public:
  using Make = std::function<Filter(const Config&)>;

  FilterTimeline(Make make, const Config& config);

  void process(const Measurement& z, Output& output) override;
  void finish(Output& output) override;
  std::optional<Estimate> current() const override;
  std::optional<Estimate> at(Stamp stamp) const override;
  const char* setState(const Estimate& state, Output& output) override;
  void configure(const Config& config) override;
  void reset() override;

 private:
  /// The filter's state at a stamp, and the turn rate in force from then on.
  struct Moment {
    Stamp stamp = 0;
    typename Filter::Belief belief;
    HeldInput input;
  };
  struct Entry {
    Measurement z;
    std::shared_ptr<const Filter> filter;  // the one in force when it came
    Moment after;
    Audit audit;
  };

  bool started() const { return anchor_.has_value(); }
  void startAnew(Output& output);
  void insert(const Measurement& z, Output& output);
  bool start();
  void replay(std::size_t first);
  Moment predicted(const Moment& from, Stamp stamp) const;
  void fuse(const Moment& from, Entry& entry) const;
  void settle(Stamp until, Output& output);
  void settleAll(Output& output);
  void giveUpFront(Output& output);
  void forget();
  const Moment& momentBefore(std::size_t index) const { return index == 0 ? *anchor_ : entries_[index - 1].after; }

  Make make_;
  Config config_;
  Model model_;
  std::shared_ptr<const Filter> filter_;
  ClockGuard clock_;
  double start_window_;           // [s]
  std::deque<Entry> entries_;     // sorted by before()
  std::optional<Moment> anchor_;  // the state before the first entry
  std::optional<Stamp> settled_;  // nothing at or before this stamp can change
  Stamp start_stamp_ = 0;         // measurements up to here decided the start
  bool start_settled_ = false;    // the start itself can no longer change
};

}  // namespace sas_motion::towfish
