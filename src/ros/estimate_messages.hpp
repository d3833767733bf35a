// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ros/conversions.hpp"

namespace sas_motion::ros_side {

/// Visits estimates and audits, each in time order, in the order of both; at one stamp audits first.
template <class Estimates, class Audits, class OnEstimate, class OnAudit>
void inTimeOrder(const Estimates& estimates, const Audits& audits, const OnEstimate& on_estimate,
                 const OnAudit& on_audit) {
  auto audit = audits.begin();
  for (const auto& estimate : estimates) {
    for (; audit != audits.end() && audit->stamp <= estimate.stamp; ++audit) on_audit(*audit);
    on_estimate(estimate);
  }
  for (; audit != audits.end(); ++audit) on_audit(*audit);
}

/// Hands everything in an output to `write(topic, stamp, message)`: NAME/odometry, NAME/fix, NAME/current for each
/// estimate, NAME/update for each audit, merged in time order.
template <class Write>
void forEachMessage(const std::string& name, const std::string& odometry, const towfish::Output& output,
                    const LocalFrame* frame, const Settings& settings, Write&& write) {
  const std::string odometry_topic = name + "/" + odometry, fix = name + "/fix", current = name + "/current",
                    update = name + "/update";
  inTimeOrder(
      output.estimates, output.audits,
      [&](const Estimate& estimate) {
        const ros::Time time = timeOf(estimate.stamp);
        write(odometry_topic, time, odometryOf(estimate, settings));
        if (frame) write(fix, time, fixOf(estimate, *frame, settings));
        write(current, time, currentOf(estimate, settings));
      },
      [&](const Audit& audit) { write(update, timeOf(audit.stamp), updateOf(audit)); });
}

}  // namespace sas_motion::ros_side
