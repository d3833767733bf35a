// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/estimate_publisher.hpp"

#include "ros/serving.hpp"

namespace sas_motion::ros_side {

EstimatePublisher::EstimatePublisher(ros::NodeHandle& node, const std::string& name)
    : odometry_(node.advertise<nav_msgs::Odometry>(name + "/odometry", kQueue)),
      current_(node.advertise<geometry_msgs::TwistWithCovarianceStamped>(name + "/current", kQueue)),
      fix_(node.advertise<sensor_msgs::NavSatFix>(name + "/fix", kQueue)),
      settled_(node.advertise<nav_msgs::Odometry>(name + "/settled", kQueue)),
      settled_current_(node.advertise<geometry_msgs::TwistWithCovarianceStamped>(name + "/settled_current", kQueue)),
      update_(node.advertise<sas_motion::FilterUpdate>(name + "/update", kQueue)) {}

void EstimatePublisher::publishNow(const Estimate& estimate, const LocalFrame* frame, const Settings& settings) const {
  publishTo(odometry_, [&] { return odometryOf(estimate, settings); });
  publishTo(current_, [&] { return currentOf(estimate, settings); });
  if (frame) publishTo(fix_, [&] { return fixOf(estimate, *frame, settings); });
}

void EstimatePublisher::queue(towfish::Output& output) {
  estimates_.insert(estimates_.end(), output.estimates.begin(), output.estimates.end());
  audits_.insert(audits_.end(), output.audits.begin(), output.audits.end());
  output.clear();
}

void EstimatePublisher::publishSettled(std::size_t most, const Settings& settings) {
  for (std::size_t i = 0; i < most && !audits_.empty(); ++i, audits_.pop_front())
    publishTo(update_, [&] { return updateOf(audits_.front()); });
  for (std::size_t i = 0; i < most && !estimates_.empty(); ++i, estimates_.pop_front()) {
    publishTo(settled_, [&] { return odometryOf(estimates_.front(), settings); });
    publishTo(settled_current_, [&] { return currentOf(estimates_.front(), settings); });
  }
}

}  // namespace sas_motion::ros_side
