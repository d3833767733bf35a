// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/ros/ingest.hpp"

#include <tf2/exceptions.h>

#include <algorithm>

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kMostWaiting = 10000;  // messages of unknown frames kept at once

}  // namespace

Ingest::Ingest(const Settings& settings, const tf2::BufferCore& transforms, Sink sink) : settings_(settings), transforms_(transforms), sink_(std::move(sink)) {
  if (settings.datum) setDatum(*settings.datum);
}

void Ingest::take(const sensor_msgs::NavSatFix& message) { receive(message, kFix); }
void Ingest::take(const sensor_msgs::Imu& message) { receive(message, kImu); }
void Ingest::take(const geometry_msgs::TwistWithCovarianceStamped& message) { receive(message, kTwist); }

void Ingest::finish() {
  for (const auto& waiting : waiting_)
    if (!waiting.convert()) ++counts_[waiting.source].unknown_frame;
  waiting_.clear();
}

template <class Message>
void Ingest::receive(const Message& message, Source source) {
  Counts& counts = counts_[source];
  ++counts.messages;
  counts.newest = stampOf(message.header.stamp);
  countLost(source, message.header.seq);
  if (!enabled_[source]) {
    ++counts.disabled;
    return;
  }
  if (!waiting_.empty()) retry();
  if (convert(message, source)) return;
  waiting_.push_back({stampOf(message.header.stamp), source, [this, message, source] { return convert(message, source); }});
}

void Ingest::retry() {
  Stamp newest = 0;
  for (const auto& counts : counts_) newest = std::max(newest, counts.newest);
  const Stamp oldest = newest - stampFromSeconds(settings_.frame_timeout);
  std::deque<Waiting> still;
  for (auto& waiting : waiting_) {
    if (waiting.convert()) continue;
    if (waiting.stamp < oldest || still.size() >= kMostWaiting)
      ++counts_[waiting.source].unknown_frame;
    else
      still.push_back(std::move(waiting));
  }
  waiting_.swap(still);
}

namespace {

std::vector<Measurement> measure(const sensor_msgs::NavSatFix& message, const std::optional<LocalFrame>& frame, const Transform& T,
                                 const towfish::Config& config) {
  return frame ? measurementsOf(message, *frame, T, config) : std::vector<Measurement>{};
}
template <class Message>
std::vector<Measurement> measure(const Message& message, const std::optional<LocalFrame>&, const Transform& T, const towfish::Config& config) {
  return measurementsOf(message, T, config);
}

void setDatumByFirstFix(const sensor_msgs::NavSatFix& fix, std::optional<LocalFrame>& frame) {
  if (!frame && hasPosition(fix)) frame.emplace(geodeticOf(fix));
}
template <class Message>
void setDatumByFirstFix(const Message&, std::optional<LocalFrame>&) {}

}  // namespace

template <class Message>
bool Ingest::convert(const Message& message, Source source) {
  const auto T_base_sensor = lookUp(message.header.frame_id);
  if (!T_base_sensor) return false;
  setDatumByFirstFix(message, frame_);
  const auto measurements = measure(message, frame_, *T_base_sensor, settings_.estimation);
  if (measurements.empty()) ++counts_[source].unusable;
  for (const auto& z : measurements) sink_(z);
  return true;
}

std::optional<Transform> Ingest::lookUp(const std::string& frame_id) const {
  const auto found = known_.find(frame_id);
  if (found != known_.end()) return found->second;
  try {
    const Transform T_base_sensor = transformOf(transforms_.lookupTransform(settings_.base_frame, frame_id, ros::Time(0)).transform);
    known_.emplace(frame_id, T_base_sensor);  // sensors are fixed to the vessel
    return T_base_sensor;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

void Ingest::countLost(Source source, std::uint32_t seq) {
  auto& last = last_seq_[source];
  if (last && seq > *last + 1 && seq - *last < 1'000'000) counts_[source].lost += seq - *last - 1;
  if (!last || seq > *last) last = seq;
}

}  // namespace sas_motion::ros_side
