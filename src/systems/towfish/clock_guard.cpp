// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/clock_guard.hpp"

#include <algorithm>
#include <utility>

namespace sas_motion::towfish {
namespace {

constexpr std::size_t kFewest = 10;  // stamps in a row that agree before they are believed
constexpr std::size_t kMost = 1000;  // held at once: without a position or a heading there is nothing to start from

}  // namespace

ClockGuard::Answer ClockGuard::judge(const Measurement& z, Output& output) {
  if (believable(z.stamp)) {
    refuseHeld(output);
    believe(z.stamp);
    return Answer::Believed;
  }
  if (!held_.empty() && (!near(z.stamp, newest_held_) || held_.size() >= kMost)) refuseHeld(output);
  newest_held_ = held_.empty() ? z.stamp : std::max(newest_held_, z.stamp);
  held_.push_back(z);
  return enough() ? Answer::ClockSet : Answer::Held;
}

/// One late sensor is no clock that was set: a position and a heading must be among those that agree.
bool ClockGuard::enough() const {
  const auto has = [this](Sensor sensor) {
    return std::any_of(held_.begin(), held_.end(), [&](const auto& z) { return z.sensor == sensor; });
  };
  return held_.size() >= kFewest && has(Sensor::Position) && has(Sensor::Heading);
}

std::vector<Measurement> ClockGuard::release() {
  newest_ = newest_held_;
  return std::exchange(held_, {});
}

void ClockGuard::refuseHeld(Output& output) {
  for (const auto& z : held_) {
    const bool ahead = z.stamp > *newest_;
    output.audits.push_back(refusal(z, ahead ? Verdict::Invalid : Verdict::Stale,
                                    ahead ? "stamp far ahead of the others" : "older than the lag"));
  }
  held_.clear();
}

}  // namespace sas_motion::towfish
