// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sas_motion::ros_side {
namespace {

constexpr double kWrongRate = 0.05;  // share by which the IMU's rate may differ from the configuration's

}  // namespace

NavigationRun::NavigationRun(const NavigationSystem& system, const ins::EstimatorFactory& make,
                             const std::vector<std::string>& names, const tf2::BufferCore& transforms, bool live)
    : SystemRun(system.map, system.sources, transforms),
      settings_(system.estimation()),
      session_(settings_.session, names, make, settings_.output_rate, live) {
  listenAt<sensor_msgs::Imu>(kImu,
                             [this](const auto& imu, const Transform& T_base_imu) { return takeImu(imu, T_base_imu); });
  listenToAiding<sensor_msgs::NavSatFix>(kFix);
  listenToAiding<geometry_msgs::TwistWithCovarianceStamped>(kTwist);
  listenToAiding<geometry_msgs::PoseWithCovarianceStamped>(kDepth);
  listen<geometry_msgs::TwistWithCovarianceStamped>(kVelocity, [this](const auto& message) {
    if (!inbox().count(message.header, kVelocity)) return;
    if (const auto velocity = groundVelocityOf(message, settings_))
      session_.process(*velocity);
    else
      inbox().countUnusable(kVelocity);
  });
}

bool NavigationRun::takeImu(const sensor_msgs::Imu& message, const Transform& T_base_imu) {
  const auto reading = readingOf(message, T_base_imu, settings_);
  if (!reading) return false;
  T_base_imu_ = T_base_imu;
  frame_.base_lever_body = InsMount{Transform::Identity(), T_base_imu}.lever_body();
  const auto& P = message.orientation_covariance;
  orientations_without_covariance_ += reading->attitude && !usableVariance(P[0]) && !usableVariance(P[8]);
  session_.process(*reading);
  return true;
}

template <class Message>
void NavigationRun::listenToAiding(Source source) {
  listenAt<Message>(source, [this](const Message& message, const Transform& T_base_sensor) -> std::optional<bool> {
    if (!T_base_imu_) return std::nullopt;
    const auto reading = readingOf(message, InsMount{T_base_sensor, *T_base_imu_}, settings_);
    if (!reading) return false;
    if (!frame_.map && reading->sensor == ins::Sensor::Gps) setDatum(geodeticOf(reading->fix));
    session_.process(*reading);
    return true;
  });
}

void NavigationRun::restart() {
  SystemRun::restart();
  T_base_imu_.reset();
  orientations_without_covariance_ = 0;
}

std::string NavigationRun::waitsFor() const {
  using Lack = ins::Alignment::Lack;
  const ins::AlignmentOptions& options = settings_.session.alignment;
  const std::string &imu = sources()[kImu].topic, &fix = sources()[kFix].topic, &velocity = sources()[kVelocity].topic;
  switch (session_.alignment().lack()) {
    case Lack::InertialUnit: return lackOf(kImu, "has no message with rates and specific forces");
    case Lack::Attitude: return fmt::format("{} has rates but no orientation, which the start needs", imu);
    case Lack::Fix: return lackOf(kFix, "has no message with a fix");
    case Lack::FixAfterAttitude:
      return fmt::format("no fix on {} comes within {} s after an orientation on {} (start.max_age)", fix,
                         options.max_age, imu);
    case Lack::Velocity:
      return fmt::format("no velocity on {}{}{} when a fix came; the start waits {} s for one (start.velocity_wait)",
                         velocity, velocity.empty() ? "" : " or ", sources()[kTwist].topic, options.velocity_wait);
    case Lack::Nothing: break;
  }
  return "";
}

std::vector<std::string> NavigationRun::warnings() const {
  std::vector<std::string> warnings;
  const ins::InertialCounts& inertial = session_.inertial();
  const auto of = [&](ImuVerdict verdict) { return inertial.verdicts[static_cast<std::size_t>(verdict)]; };
  const std::string& imu = sources()[kImu].topic;
  const double period = settings_.session.config.imu.period;
  if (inertial.mean_period > 0 && std::abs(inertial.mean_period / period - 1) > kWrongRate)
    warnings.push_back(fmt::format("{} comes {:.4g} times a second but imu.rate is {:.4g}", imu,
                                   1 / inertial.mean_period, 1 / period));
  if (of(ImuVerdict::Bridged) > 0)
    warnings.push_back(fmt::format("{} has {} gaps beyond imu.longest_gap, the longest of {:.4g} s, which were bridged",
                                   imu, of(ImuVerdict::Bridged), inertial.longest_gap));
  if (of(ImuVerdict::OffRate) > 0)
    warnings.push_back(fmt::format("{} readings of {} came off its rate", of(ImuVerdict::OffRate), imu));
  if (of(ImuVerdict::Implausible) > 0)
    warnings.push_back(fmt::format("{} readings of {} are beyond imu.max_rate_deg or imu.max_force and were left out",
                                   of(ImuVerdict::Implausible), imu));
  using Refusal = Timeline<ins::InOrder>::Queue::Refusal;
  const auto late = session_.refused(Refusal::Late), far = session_.refused(Refusal::Far),
             twice = session_.refused(Refusal::Duplicate);
  if (late + far + twice > 0)
    warnings.push_back(
        fmt::format("of {} {} readings were later than the lag, {} had a stamp far from the others and {} one that was "
                    "there before",
                    imu, late, far, twice));
  if (orientations_without_covariance_ > 0) {
    const ins::Parameters& p = settings_.session.config.parameters;
    warnings.push_back(
        fmt::format("{} orientations of {} state no covariance; {:.3g} and {:.3g} degrees are assumed for tilt and "
                    "heading (start.tilt_deg, start.heading_deg)",
                    orientations_without_covariance_, imu, p.start_tilt / kRadPerDeg, p.start_heading / kRadPerDeg));
  }
  for (std::size_t i = 0; i < sources().size(); ++i) {
    const auto& counts = inbox().counts(i);
    if (counts.messages > 0 && counts.unusable == counts.messages)
      warnings.push_back(fmt::format("none of {} messages on {} has a reading", counts.messages, sources()[i].topic));
  }
  return warnings;
}

std::vector<std::pair<std::string, std::string>> NavigationRun::details() const {
  const ins::InertialCounts& inertial = session_.inertial();
  const auto& of = inertial.verdicts;
  return {{"imu rate [1/s]", fmt::format("{:.2f}", inertial.mean_period > 0 ? 1 / inertial.mean_period : 0)},
          {"imu integrated, off its rate, over gaps, out of order, implausible",
           fmt::format("{}, {}, {}, {}, {}", of[1], of[2], of[3], of[4], of[5])}};
}

}  // namespace sas_motion::ros_side
