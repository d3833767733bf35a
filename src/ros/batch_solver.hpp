// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <mutex>
#include <vector>

#include "ros/estimate_publisher.hpp"

namespace sas_motion::ros_side {

/// Keeps the measurements of a whole run and solves them on ~solve_batch, in a thread of its own: solving takes
/// seconds, and so does publishing the answer no faster than a recorder takes it.
class BatchSolver {
 public:
  /// `settings` outlive the solver.
  BatchSolver(ros::NodeHandle node, ros::NodeHandle own, const Settings& settings);

  void take(const Measurement& z);
  void reset();

 private:
  bool onSolve(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  void receive();

  const Settings& settings_;
  std::unique_ptr<towfish::Estimator> estimator_;
  EstimatePublisher publisher_;
  std::mutex mutex_;                // of the two below: the rest belongs to the thread
  std::vector<Measurement> taken_;  // since the last solution
  bool anew_ = false;               // forget what came before them
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;
};

}  // namespace sas_motion::ros_side
