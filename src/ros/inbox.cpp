// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inbox.hpp"

#include <tf2/exceptions.h>

#include <algorithm>

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kMostWaiting = 10000;  // messages of unknown frames kept at once

}  // namespace

std::optional<Transform> SensorFrames::find(const std::string& frame_id) const {
  const auto found = known_.find(frame_id);
  if (found != known_.end()) return found->second;
  try {
    return known_[frame_id] = transformOf(transforms_.lookupTransform(base_frame_, frame_id, ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Inbox::Inbox(const SensorFrames& frames, double timeout, const std::vector<MessageSource>& sources)
    : frames_(frames), timeout_(timeout) {
  for (const auto& source : sources) sources_.push_back({{}, {}, source.enabled});
}

void Inbox::restart() {
  waiting_.clear();
  for (auto& source : sources_) source = {{}, {}, source.enabled};
}

bool Inbox::count(const std_msgs::Header& header, std::size_t source) {
  auto& [counts, last, enabled] = sources_[source];
  ++counts.messages;
  counts.newest = stampOf(header.stamp);
  if (last && header.seq > *last + 1 && header.seq - *last < 1'000'000) counts.lost += header.seq - *last - 1;
  if (!last || header.seq > *last) last = header.seq;
  counts.disabled += !enabled;
  return enabled;
}

void Inbox::retry() {
  Stamp newest = 0;
  for (const auto& source : sources_) newest = std::max(newest, source.counts.newest);
  const Stamp oldest = newest - stampFromSeconds(timeout_);
  std::deque<Waiting> still;
  for (auto& waiting : waiting_) {
    if (waiting.attempt()) continue;
    if (waiting.stamp < oldest || still.size() >= kMostWaiting)
      ++sources_[waiting.source].counts.unknown_frame;
    else
      still.push_back(std::move(waiting));
  }
  waiting_.swap(still);
}

void Inbox::finish() {
  for (const auto& waiting : waiting_)
    if (!waiting.attempt()) ++sources_[waiting.source].counts.unknown_frame;
  waiting_.clear();
}

}  // namespace sas_motion::ros_side
