// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "ros/inbox.hpp"
#include "systems/ins_gps_dvl/ros/conversions.hpp"

namespace sas_motion::ros_side {

/// Turns messages into readings of the 27-state system, live and from a bag alike. Lever arms are from the inertial
/// unit, so that the others wait for its first message. The first fix sets the datum, unless the settings do.
class InsIngest {
 public:
  using Sink = std::function<void(const ins::Reading&)>;
  enum Source { kFix, kImu, kTwist, kDepth, kVelocity, kSources };
  static constexpr std::array<const char*, kSources> kNames{"fix", "imu", "twist", "depth", "velocity"};

  /// `transforms` outlives the ingest.
  InsIngest(const InsSettings& settings, const tf2::BufferCore& transforms, Sink sink);

  void take(const sensor_msgs::Imu& message);
  void take(const sensor_msgs::NavSatFix& message);
  void take(const geometry_msgs::TwistWithCovarianceStamped& message);
  void take(const geometry_msgs::PoseWithCovarianceStamped& message);
  /// Of GNSS, over the ground.
  void takeVelocity(const geometry_msgs::TwistWithCovarianceStamped& message);
  void finish() { inbox_.finish(); }

  void setDatum(const Geodetic& datum) { frame_.emplace(datum); }
  const std::optional<LocalFrame>& frame() const { return frame_; }
  Inbox& inbox() { return inbox_; }
  const Inbox& inbox() const { return inbox_; }
  /// The base from the INS; body [m].
  Vector<3> base_lever_body() const {
    return InsMount{Transform::Identity(), T_base_imu_.value_or(Transform::Identity())}.lever_body();
  }

 private:
  template <class Message>
  void takeAiding(const Message& message, Source source);

  InsSettings settings_;
  Sink sink_;
  std::optional<LocalFrame> frame_;
  std::optional<Transform> T_base_imu_;
  Inbox inbox_;
};

}  // namespace sas_motion::ros_side
