// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2/buffer_core.h>

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ros/message_source.hpp"
#include "ros/messages.hpp"

namespace sas_motion::ros_side {

/// Where sensors sit on the vessel, by tf2. They are fixed to it, so that each is looked up once.
class SensorFrames {
 public:
  /// `transforms` outlives this.
  SensorFrames(const tf2::BufferCore& transforms, std::string base_frame)
      : transforms_(transforms), base_frame_(std::move(base_frame)) {}

  /// The pose of a frame in the base frame, or nothing while tf has none.
  std::optional<Transform> find(const std::string& frame_id) const;

 private:
  const tf2::BufferCore& transforms_;
  std::string base_frame_;
  mutable std::map<std::string, Transform> known_;
};

/// What came of a source of messages.
struct MessageCounts {
  std::uint64_t messages = 0;
  std::uint64_t unknown_frame = 0;  ///< refused: no transform to the base frame came in time
  std::uint64_t unusable = 0;       ///< without a reading: no fix, no orientation, no bottom lock
  std::uint64_t lost = 0;           ///< gaps in header.seq
  std::uint64_t disabled = 0;       ///< left, since the source is disabled
  Stamp newest = 0;  ///< of the newest message, which need not have the highest stamp: a clock may be wrong
};

/// Messages on their way from several sources to their conversion, live and from a bag alike: finds where the sensor
/// sits, keeps messages of a frame that is not yet known for a while, and counts what it refuses and what was lost on
/// the way.
class Inbox {
 public:
  Inbox(const SensorFrames& frames, double timeout, const std::vector<MessageSource>& sources);

  /// Counts a message; returns whether it is wanted. For sources without a place on the body.
  bool count(const std_msgs::Header& header, std::size_t source);
  void countUnusable(std::size_t source) { ++sources_[source].counts.unusable; }

  /// Hands a message to `convert(message, T_base_sensor)`, now or when its frame is known; it returns whether there was
  /// a reading, or nothing where the message has to wait.
  template <class Message, class Convert>
  void receive(const Message& message, std::size_t source, const Convert& convert) {
    if (!count(message.header, source)) return;
    if (!waiting_.empty()) retry();
    const auto attempt = [this, message, source, convert] {
      const auto T_base_sensor = frames_.find(message.header.frame_id);
      const std::optional<bool> read =
          T_base_sensor ? std::optional<bool>(convert(message, *T_base_sensor)) : std::nullopt;
      if (read && !*read) countUnusable(source);
      return read.has_value();
    };
    if (!attempt()) waiting_.push_back({stampOf(message.header.stamp), source, attempt});
  }
  /// Gives up on messages that still wait for their frame. Call at the end of a bag.
  void finish();
  /// Forgets counts and what waits; sources stay enabled or disabled.
  void restart();

  /// Takes a source's messages, or only counts them.
  void enable(std::size_t source, bool enabled) { sources_[source].enabled = enabled; }
  bool enabled(std::size_t source) const { return sources_[source].enabled; }
  const MessageCounts& counts(std::size_t source) const { return sources_[source].counts; }

 private:
  struct Source {
    MessageCounts counts;
    std::optional<std::uint32_t> last_seq;
    bool enabled = true;
  };
  struct Waiting {
    Stamp stamp;
    std::size_t source;
    std::function<bool()> attempt;  // true once it need not wait any more
  };

  void retry();

  SensorFrames frames_;
  double timeout_;  // [s]
  std::vector<Source> sources_;
  std::deque<Waiting> waiting_;
};

}  // namespace sas_motion::ros_side
