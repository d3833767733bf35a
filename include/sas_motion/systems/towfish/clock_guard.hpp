// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "sas_motion/systems/towfish/estimator.hpp"

namespace sas_motion::towfish {

/// Tells a clock that was set from a single wrong stamp.
///
/// A stamp far from the newest believed one, ahead or behind, is held. The next believable one contradicts it: what is
/// held is refused. Where enough in a row agree with each other instead, and they are enough to start from, the clock
/// was set, or there was a long gap.
class ClockGuard {
 public:
  enum class Answer { Believed, Held, ClockSet };

  /// For an estimator that waits `lag` for late measurements: stamps are believed up to `max_gap` after the newest
  /// believed one, or the lag where that is more, and up to the lag before it, or what is late whatever the lag [s].
  ClockGuard(double max_gap, double lag)
      : ahead_(stampFromSeconds(std::max(max_gap, lag))), behind_(stampFromSeconds(std::max(lag, kLateIsNoJump))) {}

  static constexpr double kShortenedStart =
      0.5;  ///< of the start's window, after the clock was set: an answer is waited for

  /// What to do with a measurement; refusals of those held before go to `output`. After ClockSet, release() has this
  /// one too.
  Answer judge(const Measurement& z, Output& output);
  /// Hands over the measurements that agree with each other, in order of arrival; they are believed from now on.
  std::vector<Measurement> release();
  /// Refuses what is held: the data end here.
  void refuseHeld(Output& output);
  /// The time is at least this, whatever the measurements say.
  void believe(Stamp stamp) { newest_ = newest_ ? std::max(*newest_, stamp) : stamp; }
  /// True where a stamp is not too far ahead to be believed.
  bool believable(Stamp stamp) const { return !newest_ || near(stamp, *newest_); }
  void reset() { *this = ClockGuard(ahead_, behind_); }

 private:
  static constexpr double kLateIsNoJump = 1;  // [s]
  ClockGuard(Stamp ahead, Stamp behind) : ahead_(ahead), behind_(behind) {}
  bool near(Stamp stamp, Stamp newest) const { return stamp <= newest + ahead_ && stamp >= newest - behind_; }
  bool enough() const;

  Stamp ahead_, behind_;
  std::optional<Stamp> newest_;    // believed
  std::vector<Measurement> held_;  // near each other, not near newest_
  Stamp newest_held_ = 0;
};

}  // namespace sas_motion::towfish
