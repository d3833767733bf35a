// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/batch_solver.hpp"

#include <fmt/format.h>

namespace sas_motion::ros_side {
namespace {

const std::string kBatch = "batch";
constexpr double kBetweenReceipts = 1;  // messages wait so long to be converted, which is all that is kept of them [s]

}  // namespace

BatchSolver::BatchSolver(ros::NodeHandle node, ros::NodeHandle own, const System& system,
                         const tf2::BufferCore& transforms)
    : system_(system),
      run_((system.require({kBatch}), system.begin({kBatch}, transforms, false))),
      publisher_(node, kBatch, system.has_current),
      spinner_(1, &queue_) {
  own.setCallbackQueue(&queue_);
  service_ = own.advertiseService("solve_batch", &BatchSolver::onSolve, this);
  timer_ = own.createWallTimer(ros::WallDuration(kBetweenReceipts), [this](const ros::WallTimerEvent&) { receive(); });
  spinner_.start();
}

void BatchSolver::take(SystemRun::Delivery message) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(message));
}

void BatchSolver::restart() {
  take([this](SystemRun& run) {
    run.restart();
    publisher_.clear();
  });
}

void BatchSolver::receive() {
  std::vector<SystemRun::Delivery> fresh;
  {
    const std::lock_guard lock(mutex_);
    fresh.swap(waiting_);
  }
  for (const auto& message : fresh) message(*run_);
  run_->session().feed();
}

bool BatchSolver::onSolve(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  receive();
  const ros::WallTime begin = ros::WallTime::now();
  run_->session().finish();
  const double seconds = (ros::WallTime::now() - begin).toSec();
  Output output;
  run_->session().takeSettled(0, run_->frame(), output);
  const std::size_t states = output.solutions.size();
  publisher_.queue(output);
  while (ros::ok() && !publisher_.nothingQueued()) {
    publisher_.publishSettled(kBurst, system_.map);
    ros::WallDuration(kBetweenBursts).sleep();
  }
  const std::string failure = run_->session().report(0).failure;
  response.success = states > 0;
  response.message = states > 0        ? fmt::format("{} states in {:.2f} s", states, seconds)
                     : failure.empty() ? "nothing solved: nothing new since the last solution"
                                       : "nothing solved: " + failure;
  return true;
}

}  // namespace sas_motion::ros_side
