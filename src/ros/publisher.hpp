// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <boost/make_shared.hpp>
#include <deque>
#include <string>

#include "ros/solution_messages.hpp"

namespace sas_motion::ros_side {

// A whole recording at once would overrun its subscribers: rosbag record keeps 100 messages of a topic.
constexpr std::size_t kBurst = 25;       // messages of a topic at once
constexpr double kBetweenBursts = 0.05;  // [s]

/// Publishes make() where somebody listens; by pointer, so that a nodelet of the same manager gets it without a copy.
template <class Make>
void publishTo(const ros::Publisher& publisher, const Make& make) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<std::decay_t<decltype(make())>>(make()));
}

/// The topics of one estimator. Messages to which nobody listens are not made.
class EstimatePublisher {
 public:
  /// `has_current`: NAME/current and NAME/settled_current too.
  EstimatePublisher(ros::NodeHandle& node, const std::string& name, bool has_current);

  /// NAME/odometry, NAME/current and, where its place is known, NAME/fix.
  void publishNow(const Solution& solution, const MapSettings& settings) const;
  /// Whether somebody listens to what publishNow() publishes.
  bool heard() const;

  /// Takes what is settled; it goes out with publishSettled().
  void queue(const Output& output);
  /// Of the queue, up to `most` solutions on NAME/settled and NAME/settled_current, and as many audits on NAME/update.
  void publishSettled(std::size_t most, const MapSettings& settings);
  /// Forgets what is queued.
  void clear();
  bool nothingQueued() const { return solutions_.empty() && audits_.empty(); }

 private:
  ros::Publisher odometry_, current_, fix_, settled_, settled_current_, update_;
  std::deque<Solution> solutions_;
  std::deque<Audit> audits_;
};

}  // namespace sas_motion::ros_side
