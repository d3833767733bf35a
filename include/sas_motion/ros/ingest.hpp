// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2/buffer_core.h>

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "sas_motion/ros/conversions.hpp"

namespace sas_motion::ros_side {

/// Turns messages into measurements, live and from a bag alike: finds the sensor's place by tf2, sets the datum by the first fix, keeps
/// messages of a frame that is not yet known for a while, and counts what it refuses and what was lost on the way.
class Ingest {
 public:
  using Sink = std::function<void(const Measurement&)>;

  struct Counts {
    std::uint64_t messages = 0;
    std::uint64_t unknown_frame = 0;  ///< refused: no transform to the base frame came in time
    std::uint64_t unusable = 0;       ///< no fix, no orientation
    std::uint64_t lost = 0;           ///< gaps in header.seq
    std::uint64_t disabled = 0;       ///< left, since the sensor is disabled
    Stamp newest = 0;                 ///< of the newest message, which need not have the highest stamp: a clock may be wrong
  };
  enum Source { kFix, kImu, kTwist, kSources };
  static constexpr std::array<const char*, kSources> kNames{"fix", "imu", "twist"};

  /// `transforms` outlives the ingest.
  Ingest(const Settings& settings, const tf2::BufferCore& transforms, Sink sink);

  void take(const sensor_msgs::NavSatFix& message);
  void take(const sensor_msgs::Imu& message);
  void take(const geometry_msgs::TwistWithCovarianceStamped& message);
  /// Takes a sensor's messages, or only counts them.
  void enable(Source source, bool enabled) { enabled_[source] = enabled; }
  bool enabled(Source source) const { return enabled_[source]; }
  /// Gives up on messages that still wait for their frame. Call at the end of a bag.
  void finish();

  /// Sets the origin of the map frame.
  void setDatum(const Geodetic& datum) { frame_.emplace(datum); }
  const std::optional<LocalFrame>& frame() const { return frame_; }
  const Counts& counts(Source source) const { return counts_[source]; }

 private:
  template <class Message>
  void receive(const Message& message, Source source);
  template <class Message>
  bool convert(const Message& message, Source source);
  std::optional<Transform> lookUp(const std::string& frame_id) const;
  void retry();
  void countLost(Source source, std::uint32_t seq);

  Settings settings_;
  const tf2::BufferCore& transforms_;
  Sink sink_;
  std::optional<LocalFrame> frame_;
  std::array<Counts, kSources> counts_{};
  std::array<bool, kSources> enabled_{true, true, true};
  std::array<std::optional<std::uint32_t>, kSources> last_seq_{};
  struct Waiting {
    Stamp stamp;
    Source source;
    std::function<bool()> convert;  // true once the frame is known
  };
  std::deque<Waiting> waiting_;
  mutable std::map<std::string, Transform> known_;
};

}  // namespace sas_motion::ros_side
