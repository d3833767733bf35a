// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/system_run.hpp"

#include <fmt/format.h>

namespace sas_motion::ros_side {

SystemRun::SystemRun(const MapSettings& settings, std::vector<MessageSource> sources, const tf2::BufferCore& transforms)
    : sources_(std::move(sources)),
      inbox_(SensorFrames(transforms, settings.base_frame), settings.frame_timeout, sources_),
      handlers_(sources_.size()) {
  if (settings.datum) setDatum(*settings.datum);
}

std::vector<ros::Subscriber> SystemRun::subscribe(ros::NodeHandle& node,
                                                  const std::function<void(Delivery)>& receive) const {
  std::vector<ros::Subscriber> subscribers;
  for (std::size_t i = 0; i < sources_.size(); ++i)
    if (!sources_[i].topic.empty()) subscribers.push_back(handlers_[i].subscribe(node, receive));
  return subscribers;
}

void SystemRun::finish() {
  inbox_.finish();
  session().finish();
}

std::string SystemRun::lackOf(std::size_t source, const std::string& otherwise) const {
  const std::string& topic = sources_[source].topic;
  const MessageCounts& counts = inbox_.counts(source);
  if (counts.messages > 0 && counts.disabled == counts.messages) return topic + " is disabled";
  if (counts.unknown_frame > 0 && counts.unknown_frame + counts.unusable == counts.messages)
    return fmt::format(
        "{}: {} of {} messages have a frame_id without a transform to the base (frames.base; is there a /tf_static?)",
        topic, counts.unknown_frame, counts.messages);
  return fmt::format("{} {}", topic, otherwise);
}

void SystemRun::restart() {
  inbox_.restart();
  session().reset();
}

}  // namespace sas_motion::ros_side
