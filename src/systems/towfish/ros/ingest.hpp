// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "ros/inbox.hpp"

namespace sas_motion::ros_side {

/// Turns messages into measurements, live and from a bag alike. The first fix sets the datum, unless the settings do.
class Ingest {
 public:
  using Sink = std::function<void(const Measurement&)>;
  using Counts = MessageCounts;  ///< unusable: no fix, no orientation
  enum Source { kFix, kImu, kTwist, kSources };
  static constexpr std::array<const char*, kSources> kNames{"fix", "imu", "twist"};

  /// `transforms` outlives the ingest.
  Ingest(const Settings& settings, const tf2::BufferCore& transforms, Sink sink);

  void take(const sensor_msgs::NavSatFix& message);
  void take(const sensor_msgs::Imu& message);
  void take(const geometry_msgs::TwistWithCovarianceStamped& message);
  /// Takes a sensor's messages, or only counts them.
  void enable(Source source, bool enabled) { inbox_.enable(source, enabled); }
  bool enabled(Source source) const { return inbox_.enabled(source); }
  /// Gives up on messages that still wait for their frame. Call at the end of a bag.
  void finish() { inbox_.finish(); }

  /// Sets the origin of the map frame.
  void setDatum(const Geodetic& datum) { frame_.emplace(datum); }
  const std::optional<LocalFrame>& frame() const { return frame_; }
  const Counts& counts(Source source) const { return inbox_.counts(source); }
  const Inbox& inbox() const { return inbox_; }

 private:
  /// Returns whether there was any.
  bool pass(const std::vector<Measurement>& measurements) const;

  Settings settings_;
  Sink sink_;
  std::optional<LocalFrame> frame_;
  Inbox inbox_;
};

}  // namespace sas_motion::ros_side
