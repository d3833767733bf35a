// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/reading.hpp"

namespace sas_motion::ins {

/// Puts readings that come in any order into that of time, as long as none is later than a lag behind the inertial
/// unit, whose stamps are the clock. One stamp of it far from the others is not believed; where several in a row agree
/// with each other, the clock was set, or there was a long gap.
class ReadingQueue {
 public:
  enum class Answer {
    Taken,
    Late,       ///< older than the lag
    Duplicate,  ///< another of its sensor has its stamp
    Far,        ///< a stamp far from those of the inertial unit
    ClockSet,   ///< take everything, then restart()
  };

  /// Stamps are believed up to `max_gap`, or the lag where that is more, after the newest of the inertial unit [s].
  ReadingQueue(double lag, double max_gap)
      : lag_(stampFromSeconds(lag)), max_gap_(stampFromSeconds(std::max(lag, max_gap))) {}

  Answer insert(const Reading& reading);
  /// Where the last reading that was taken is among the open ones.
  std::size_t place() const { return place_; }
  /// The readings whose order can still change, in time order.
  const std::deque<Reading>& open() const { return open_; }
  /// Whether the first of them can no longer change.
  bool settles() const { return !open_.empty() && newest_ && stampOf(open_.front()) <= *newest_ - lag_; }
  Reading takeFirst();
  /// Begins anew with the readings that the new clock was told by.
  void restart();

 private:
  bool believable(Stamp stamp) const;
  Answer hold(const Reading& reading);
  Answer put(const Reading& reading);

  Stamp lag_, max_gap_;
  std::deque<Reading> open_;
  std::size_t place_ = 0;
  std::optional<Stamp> newest_, settled_;
  std::vector<Reading> held_;  // of the inertial unit, that agree with each other and not with newest_
};

}  // namespace sas_motion::ins
