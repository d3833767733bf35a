// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/remarks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sas_motion::ros_side {
namespace {

constexpr double kWrongRate = 0.05;  // share by which the inertial unit's rate may differ from the configuration's

std::string topicOf(std::size_t source, const InsSettings& settings) {
  const std::array<const std::string*, InsIngest::kSources> topics{
      &settings.fix_topic, &settings.imu_topic, &settings.twist_topic, &settings.depth_topic, &settings.velocity_topic};
  return *topics[source];
}

}  // namespace

std::string whyNotStarted(const ins::Alignment& alignment, const InsSettings& settings) {
  using Lack = ins::Alignment::Lack;
  const ins::AlignmentOptions& options = settings.estimation.session.alignment;
  switch (alignment.lack()) {
    case Lack::InertialUnit: return fmt::format("{} has no message with rates and specific forces", settings.imu_topic);
    case Lack::Attitude:
      return fmt::format("{} has rates but no orientation, which the start needs", settings.imu_topic);
    case Lack::Fix: return fmt::format("{} has no message with a fix", settings.fix_topic);
    case Lack::FixAfterAttitude:
      return fmt::format("no fix on {} comes within {} s after an orientation on {} (start.max_age)",
                         settings.fix_topic, options.max_age, settings.imu_topic);
    case Lack::Velocity:
      return fmt::format("no velocity on {}{}{} when a fix came; the start waits {} s for one (start.velocity_wait)",
                         settings.velocity_topic, settings.velocity_topic.empty() ? "" : " or ", settings.twist_topic,
                         options.velocity_wait);
    case Lack::Nothing: break;
  }
  return "";
}

std::vector<std::string> remarksOn(const ins::InertialCounts& inertial, const Inbox& inbox,
                                   const InsSettings& settings) {
  std::vector<std::string> remarks;
  const auto of = [&](ImuVerdict verdict) { return inertial.verdicts[static_cast<std::size_t>(verdict)]; };
  const std::string& imu = settings.imu_topic;
  const double period = settings.estimation.session.config.imu.period;
  if (inertial.mean_period > 0 && std::abs(inertial.mean_period / period - 1) > kWrongRate)
    remarks.push_back(fmt::format("{} comes {:.4g} times a second but imu.rate is {:.4g}", imu,
                                  1 / inertial.mean_period, 1 / period));
  if (of(ImuVerdict::Bridged) > 0)
    remarks.push_back(fmt::format("{} has {} gaps beyond imu.longest_gap, the longest of {:.4g} s, which were bridged",
                                  imu, of(ImuVerdict::Bridged), inertial.longest_gap));
  if (of(ImuVerdict::OffRate) > 0)
    remarks.push_back(fmt::format("{} readings of {} came off its rate", of(ImuVerdict::OffRate), imu));
  if (of(ImuVerdict::Implausible) > 0)
    remarks.push_back(fmt::format("{} readings of {} are beyond imu.max_rate_deg or imu.max_force and were left out",
                                  of(ImuVerdict::Implausible), imu));
  if (inertial.late + inertial.far + inertial.duplicate > 0)
    remarks.push_back(
        fmt::format("of {} {} readings were later than the lag, {} had a stamp far from the others and {} one that was "
                    "there before",
                    imu, inertial.late, inertial.far, inertial.duplicate));
  for (std::size_t source = 0; source < InsIngest::kSources; ++source) {
    const auto& counts = inbox.counts(source);
    if (counts.messages > 0 && counts.unusable == counts.messages)
      remarks.push_back(
          fmt::format("none of {} messages on {} has a reading", counts.messages, topicOf(source, settings)));
  }
  return remarks;
}

}  // namespace sas_motion::ros_side
