// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/serving.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kSilent = 5;            // a sensor without messages for so long is reported [s]
constexpr double kManyRejections = 0.5;  // share of measurements not fused or down-weighted that is reported

}  // namespace

void broadcastPose(tf2_ros::TransformBroadcaster& broadcaster, const nav_msgs::Odometry& odometry,
                   const MapSettings& settings) {
  geometry_msgs::TransformStamped map_to_odom, odom_to_base;
  map_to_odom.header.stamp = odom_to_base.header.stamp = odometry.header.stamp;
  map_to_odom.header.frame_id = settings.map_frame;
  map_to_odom.child_frame_id = odom_to_base.header.frame_id = settings.odom_frame;
  map_to_odom.transform.rotation.w = 1;
  odom_to_base.child_frame_id = settings.base_frame;
  odom_to_base.transform.translation.x = odometry.pose.pose.position.x;
  odom_to_base.transform.translation.y = odometry.pose.pose.position.y;
  odom_to_base.transform.translation.z = odometry.pose.pose.position.z;
  odom_to_base.transform.rotation = odometry.pose.pose.orientation;
  broadcaster.sendTransform(std::vector<geometry_msgs::TransformStamped>{map_to_odom, odom_to_base});
}

void diagnoseSource(const MessageCounts& counts, bool enabled, const std::string& name, Stamp newest,
                    const MapSettings& settings, DiagnosticStatus& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.addf(name + " messages", "%lu", counts.messages);
  status.addf(name + " lost", "%lu", counts.lost);
  status.addf(name + " of unknown frame", "%lu", counts.unknown_frame);
  status.addf(name + " without a reading", "%lu", counts.unusable);
  status.addf(name + " while disabled", "%lu", counts.disabled);
  if (counts.messages > 0) status.addf(name + " age [s]", "%.2f", secondsBetween(counts.newest, newest));
  const bool expected = counts.messages > 0 && !counts.may_fall_silent;
  if (expected && secondsBetween(counts.newest, newest) > kSilent)
    status.mergeSummary(DiagnosticStatus::WARN, name + " is silent");
  if (!enabled) status.mergeSummary(DiagnosticStatus::WARN, name + " is disabled");
  if (counts.unknown_frame > 0)
    status.mergeSummary(DiagnosticStatus::ERROR, name + " has a frame without a transform to " + settings.base_frame);
  if (counts.lost > 0)
    status.mergeSummary(DiagnosticStatus::WARN, fmt::format("{} messages of {} lost", counts.lost, name));
}

void diagnoseVerdicts(const std::string& estimator, const std::array<std::uint64_t, 5>& verdicts,
                      DiagnosticStatus& status) {
  std::uint64_t all = 0;
  for (const auto count : verdicts) all += count;
  status.addf(estimator + " accepted, down-weighted, rejected, stale, invalid", "%lu, %lu, %lu, %lu, %lu", verdicts[0],
              verdicts[1], verdicts[2], verdicts[3], verdicts[4]);
  const double refused = all > 0 ? 1 - static_cast<double>(verdicts[0]) / static_cast<double>(all) : 0;
  status.addf(estimator + " not accepted [%]", "%.1f", 100 * refused);
  if (refused > kManyRejections)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        estimator + " does not accept most of its measurements");
}

void diagnoseLatency(const LatencyMeter& latency, const LatencyMeter& callback, DiagnosticStatus& status) {
  status.addf("callback to publication p50 [ms]", "%.3f", 1e3 * latency.quantile(0.5));
  status.addf("callback to publication p99 [ms]", "%.3f", 1e3 * latency.quantile(0.99));
  status.addf("whole callback p99 [ms]", "%.3f", 1e3 * callback.quantile(0.99));
  status.addf("callbacks", "%lu", latency.count());
}

}  // namespace sas_motion::ros_side
