// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/publisher.hpp"

#include "ros/system_run.hpp"

namespace sas_motion::ros_side {

EstimatePublisher::EstimatePublisher(ros::NodeHandle& node, const std::string& name, bool has_current)
    : odometry_(node.advertise<nav_msgs::Odometry>(name + "/odometry", kQueue)),
      fix_(node.advertise<sensor_msgs::NavSatFix>(name + "/fix", kQueue)),
      settled_(node.advertise<nav_msgs::Odometry>(name + "/settled", kQueue)),
      update_(node.advertise<sas_motion::FilterUpdate>(name + "/update", kQueue)) {
  if (!has_current) return;
  using Twist = geometry_msgs::TwistWithCovarianceStamped;
  current_ = node.advertise<Twist>(name + "/current", kQueue);
  settled_current_ = node.advertise<Twist>(name + "/settled_current", kQueue);
}

bool EstimatePublisher::heard() const {
  const auto listened = [](const ros::Publisher& publisher) { return publisher && publisher.getNumSubscribers() > 0; };
  return listened(odometry_) || listened(fix_) || listened(current_);
}

void EstimatePublisher::publishNow(const Solution& solution, const MapSettings& settings) const {
  publishTo(odometry_, [&] { return odometryOf(solution, settings); });
  if (solution.current && current_) publishTo(current_, [&] { return currentOf(solution, settings); });
  if (solution.place) publishTo(fix_, [&] { return fixOf(solution, settings); });
}

void EstimatePublisher::queue(const Output& output) {
  solutions_.insert(solutions_.end(), output.solutions.begin(), output.solutions.end());
  audits_.insert(audits_.end(), output.audits.begin(), output.audits.end());
}

void EstimatePublisher::publishSettled(std::size_t most, const MapSettings& settings) {
  for (std::size_t i = 0; i < most && !audits_.empty(); ++i, audits_.pop_front())
    publishTo(update_, [&] { return updateOf(audits_.front()); });
  for (std::size_t i = 0; i < most && !solutions_.empty(); ++i, solutions_.pop_front()) {
    const Solution& solution = solutions_.front();
    publishTo(settled_, [&] { return odometryOf(solution, settings); });
    if (solution.current && settled_current_)
      publishTo(settled_current_, [&] { return currentOf(solution, settings); });
  }
}

void EstimatePublisher::clear() {
  solutions_.clear();
  audits_.clear();
}

}  // namespace sas_motion::ros_side
