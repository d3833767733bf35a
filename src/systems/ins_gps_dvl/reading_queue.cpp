// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/reading_queue.hpp"

#include <algorithm>
#include <utility>

namespace sas_motion::ins {
namespace {

constexpr std::size_t kAgree = 10;                  // readings in a row before a new clock is believed
constexpr Stamp kAgreeing = kNanosecondsPerSecond;  // between two of them
constexpr std::size_t kMostBefore = 1000;           // readings kept before the inertial unit's first

bool before(const Reading& a, const Reading& b) { return placeOf(a) < placeOf(b); }

}  // namespace

ReadingQueue::Answer ReadingQueue::insert(const Reading& reading) {
  const Stamp stamp = stampOf(reading);
  const bool of_unit = std::holds_alternative<InertialReading>(reading);
  if (!believable(stamp)) return of_unit ? hold(reading) : stamp < *newest_ ? Answer::Late : Answer::Far;
  if (of_unit) {
    held_.clear();
    newest_ = newest_ ? std::max(*newest_, stamp) : stamp;
  }
  return put(reading);
}

bool ReadingQueue::believable(Stamp stamp) const {
  return !newest_ || (stamp <= *newest_ + max_gap_ && stamp >= *newest_ - std::max(lag_, kNanosecondsPerSecond));
}

ReadingQueue::Answer ReadingQueue::hold(const Reading& reading) {
  const Stamp stamp = stampOf(reading);
  if (!held_.empty() && (stamp <= stampOf(held_.back()) || stamp > stampOf(held_.back()) + kAgreeing)) held_.clear();
  held_.push_back(reading);
  return held_.size() >= kAgree ? Answer::ClockSet : Answer::Far;
}

ReadingQueue::Answer ReadingQueue::put(const Reading& reading) {
  if (settled_ && stampOf(reading) <= *settled_) return Answer::Late;
  const auto place = std::lower_bound(open_.begin(), open_.end(), reading, before);
  if (place != open_.end() && !before(reading, *place)) return Answer::Duplicate;
  place_ = static_cast<std::size_t>(place - open_.begin());
  open_.insert(place, reading);
  if (!newest_ && open_.size() > kMostBefore) open_.pop_front();
  return Answer::Taken;
}

Reading ReadingQueue::takeFirst() {
  Reading first = std::move(open_.front());
  open_.pop_front();
  settled_ = stampOf(first);
  return first;
}

void ReadingQueue::restart() {
  open_.clear();
  settled_.reset();
  newest_.reset();
  for (const auto& reading : std::exchange(held_, {})) insert(reading);
}

}  // namespace sas_motion::ins
