// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/ins_gps_dvl/session.hpp"
#include "systems/ins_gps_dvl/ros/conversions.hpp"
#include "systems/ins_gps_dvl/ros/system.hpp"

namespace sas_motion::ros_side {

/// Messages become readings of an INS. Lever arms are from the IMU, so that the other sensors wait for its first
/// message.
class NavigationRun final : public SystemRun {
 public:
  enum Source { kFix, kImu, kTwist, kDepth, kVelocity };

  /// `system` outlives the run.
  NavigationRun(const NavigationSystem& system, const ins::EstimatorFactory& make,
                const std::vector<std::string>& names, const tf2::BufferCore& transforms, bool live);

  Session& session() override { return session_; }
  void restart() override;
  std::string waitsFor() const override;
  std::vector<std::string> warnings() const override;
  std::vector<std::pair<std::string, std::string>> details() const override;

 private:
  template <class Message>
  void listenToAiding(Source source);
  bool takeImu(const sensor_msgs::Imu& message, const Transform& T_base_imu);

  const ins::Settings& settings_;
  std::optional<Transform> T_base_imu_;
  std::uint64_t orientations_without_covariance_ = 0;
  ins::NavigationSession session_;
};

}  // namespace sas_motion::ros_side
