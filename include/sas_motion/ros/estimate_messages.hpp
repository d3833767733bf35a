// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/ros/conversions.hpp"

namespace sas_motion::ros_side {

/// Hands everything in an output to `write(topic, stamp, message)`: NAME/odometry, NAME/fix, NAME/current for each estimate, NAME/update
/// for each audit, merged in time order.
template <class Write>
void forEachMessage(const std::string& name, const std::string& odometry, const towfish::Output& output, const LocalFrame* frame, const Settings& settings,
                    Write&& write) {
  const std::string odometry_topic = name + "/" + odometry, fix = name + "/fix", current = name + "/current", update = name + "/update";
  auto audit = output.audits.begin();
  for (const auto& estimate : output.estimates) {
    for (; audit != output.audits.end() && audit->stamp <= estimate.stamp; ++audit) write(update, timeOf(audit->stamp), updateOf(*audit));
    const ros::Time time = timeOf(estimate.stamp);
    write(odometry_topic, time, odometryOf(estimate, settings));
    if (frame) write(fix, time, fixOf(estimate, *frame, settings));
    write(current, time, currentOf(estimate, settings));
  }
  for (; audit != output.audits.end(); ++audit) write(update, timeOf(audit->stamp), updateOf(*audit));
}

}  // namespace sas_motion::ros_side
