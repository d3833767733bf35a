// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>

#include <mutex>

#include "ros/publisher.hpp"
#include "ros/system.hpp"

namespace sas_motion::ros_side {

/// Takes the messages of a whole run and solves them by `batch` on ~solve_batch, in a thread of its own: solving takes
/// seconds, and so does publishing the answer no faster than a recorder takes it.
class BatchSolver {
 public:
  /// `system` and `transforms` outlive the solver. Throws std::runtime_error where the system has no batch.
  BatchSolver(ros::NodeHandle node, ros::NodeHandle own, const System& system, const tf2::BufferCore& transforms);

  void take(SystemRun::Delivery message);
  void restart();

 private:
  void receive();
  bool onSolve(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  const System& system_;
  std::unique_ptr<SystemRun> run_;
  EstimatePublisher publisher_;
  std::mutex mutex_;  // of the next one: the rest belongs to the thread
  std::vector<SystemRun::Delivery> waiting_;
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_;
};

}  // namespace sas_motion::ros_side
