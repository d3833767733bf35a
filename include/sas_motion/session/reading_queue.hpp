// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sas_motion/math/stamp.hpp"

namespace sas_motion {

/// Puts readings that come in any order into the order of time, and tells a clock that was set from a wrong stamp.
///
/// A stamp far from the newest accepted one, ahead or behind, is held. The next stamp near the newest one contradicts
/// it: what is held is refused. Where enough in a row agree with each other instead, the clock was set, or there was a
/// long gap.
///
/// A system defines for its Reading: stampOf(r); before(a, b); tellsTime(r), whether its sensor's stamps are the clock;
/// and suffices(readings), whether an estimate can start from them.
template <class Reading, class Config>
class ReadingQueue {
 public:
  /// A reading with the settings in force when it came.
  struct Entry {
    Reading reading;
    std::shared_ptr<const Config> config;
  };
  using Entries = std::deque<Entry>;
  enum class Answer { Taken, NotTaken, ClockSet };
  enum class Refusal { Late, Far, Duplicate };

  /// Readings wait `lag` for late ones. Stamps are accepted up to `max_gap` after the newest one, or the lag where that
  /// is more, and up to the lag before it [s]. With an infinite lag all stamps are accepted, and none is late.
  ReadingQueue(double lag, double max_gap)
      : lag_(stampFromSeconds(std::min(lag, kForEver))),
        ahead_(std::max(lag_, stampFromSeconds(max_gap))),
        behind_(std::max(lag_, stampFromSeconds(kLateIsNoJump))) {}

  /// Calls refuse(reading, Refusal) for each reading that is not used. After ClockSet the caller settles what is open
  /// and calls startAnew().
  template <class Refuse>
  Answer insert(Entry entry, const Refuse& refuse) {
    const Stamp stamp = stampOf(entry.reading);
    if (!nearNewest(stamp)) return tellsTime(entry.reading) ? hold(entry.reading, refuse) : far(entry.reading, refuse);
    if (tellsTime(entry.reading)) {
      refuseHeld(refuse);
      newest_ = std::max(stamp, newest_.value_or(stamp));
    }
    if (settled_ && stamp <= *settled_) {
      refuse(entry.reading, Refusal::Late);
      return Answer::NotTaken;
    }
    put(std::move(entry));
    if (!newest_ && open_.size() > kMost) {
      refuse(open_.front().reading, Refusal::Late);
      open_.pop_front();
      if (place_-- == 0) return Answer::NotTaken;
    }
    return Answer::Taken;
  }

  /// Begins anew with the readings that the new clock was recognised by; nothing is open.
  void startAnew(const std::shared_ptr<const Config>& config) {
    settled_.reset();
    newest_ = newest_held_;
    for (auto& reading : std::exchange(held_, {})) put({std::move(reading), config});
  }

  /// Refuses what is held: the data end here.
  template <class Refuse>
  void refuseHeld(const Refuse& refuse) {
    for (const auto& reading : held_) far(reading, refuse);
    held_.clear();
  }

  /// The readings whose order can still change, in time order; one of a sensor and stamp that are there already comes
  /// right after the first.
  const Entries& open() const { return open_; }
  /// Where the last reading that was taken is among them.
  std::size_t place() const { return place_; }
  /// How many of them can no longer change.
  std::size_t settling() const { return newest_ ? countUntil(*newest_ - lag_) : 0; }
  std::size_t countUntil(Stamp stamp) const {
    std::size_t count = 0;
    while (count < open_.size() && stampOf(open_[count].reading) <= stamp) ++count;
    return count;
  }
  /// Whether an entry has the sensor and stamp of the one before it.
  bool isDuplicate(std::size_t index) const {
    return index > 0 && !before(open_[index - 1].reading, open_[index].reading);
  }
  /// Lets go of the first entries; nothing is taken at or before the last of them any more.
  void drop(std::size_t count) {
    if (count == 0) return;
    if (lag_ < stampFromSeconds(kForEver)) settled_ = stampOf(open_[count - 1].reading);
    open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(count));
  }
  /// The time is at least this, whatever the readings say, and nothing is taken at or before it.
  void settleUntil(Stamp stamp) {
    settled_ = stamp;
    newest_ = std::max(stamp, newest_.value_or(stamp));
  }

  bool hasSettledAfter(Stamp stamp) const { return settled_ && stamp < *settled_; }
  bool nearNewest(Stamp stamp) const { return !newest_ || near(stamp, *newest_); }

 private:
  static constexpr double kLateIsNoJump = 1;  // [s]
  static constexpr double kForEver = 4e9;     // longer than stamps differ [s]
  static constexpr std::size_t kFewest = 10;  // stamps in a row that agree before they are accepted
  static constexpr std::size_t kMost = 1000;  // held at once, and kept before the clock's first stamp

  bool near(Stamp stamp, Stamp newest) const { return stamp <= newest + ahead_ && stamp >= newest - behind_; }

  template <class Refuse>
  Answer far(const Reading& reading, const Refuse& refuse) {
    refuse(reading, stampOf(reading) > *newest_ ? Refusal::Far : Refusal::Late);
    return Answer::NotTaken;
  }

  template <class Refuse>
  Answer hold(const Reading& reading, const Refuse& refuse) {
    const Stamp stamp = stampOf(reading);
    const auto same = [&](const Reading& other) { return !before(reading, other) && !before(other, reading); };
    if (std::any_of(held_.begin(), held_.end(), same)) return far(reading, refuse);  // a clock that stands still
    if (!held_.empty() && (!near(stamp, newest_held_) || held_.size() >= kMost)) refuseHeld(refuse);
    newest_held_ = held_.empty() ? stamp : std::max(newest_held_, stamp);
    held_.push_back(reading);
    return held_.size() >= kFewest && suffices(held_) ? Answer::ClockSet : Answer::NotTaken;
  }

  void put(Entry entry) {
    const auto place = std::upper_bound(open_.begin(), open_.end(), entry,
                                        [](const Entry& a, const Entry& b) { return before(a.reading, b.reading); });
    place_ = static_cast<std::size_t>(place - open_.begin());
    open_.insert(place, std::move(entry));
  }

  Stamp lag_, ahead_, behind_;
  Entries open_;
  std::size_t place_ = 0;
  std::optional<Stamp> newest_, settled_;
  std::vector<Reading> held_;  // near each other, not near newest_
  Stamp newest_held_ = 0;
};

}  // namespace sas_motion
