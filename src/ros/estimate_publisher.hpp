// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <deque>
#include <string>

#include "ros/conversions.hpp"

namespace sas_motion::ros_side {

/// The topics of one estimator. Messages to which nobody listens are not made.
class EstimatePublisher {
 public:
  EstimatePublisher(ros::NodeHandle& node, const std::string& name);

  /// NAME/odometry, NAME/current and, with a frame, NAME/fix.
  void publishNow(const Estimate& estimate, const LocalFrame* frame, const Settings& settings) const;

  /// Takes what is settled; it goes out with publishSettled().
  void queue(towfish::Output& output);
  /// Of the queue, up to `most` estimates on NAME/settled and NAME/settled_current, and as many audits on NAME/update.
  void publishSettled(std::size_t most, const Settings& settings);
  /// Forgets what is queued.
  void clear() {
    estimates_.clear();
    audits_.clear();
  }
  bool nothingQueued() const { return estimates_.empty() && audits_.empty(); }

 private:
  ros::Publisher odometry_, current_, fix_, settled_, settled_current_, update_;
  std::deque<Estimate> estimates_;
  std::deque<Audit> audits_;
};

}  // namespace sas_motion::ros_side
