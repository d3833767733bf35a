// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/batch_solver.hpp"

#include <fmt/format.h>

#include <utility>

#include "ros/serving.hpp"
#include "systems/towfish/graph/estimators.hpp"

namespace sas_motion::ros_side {

BatchSolver::BatchSolver(ros::NodeHandle node, ros::NodeHandle own, const Settings& settings)
    : settings_(settings),
      estimator_(towfish::makeAnyEstimator("batch", settings.estimation)),
      publisher_(node, "batch"),
      spinner_(1, &queue_) {
  own.setCallbackQueue(&queue_);
  service_ = own.advertiseService("solve_batch", &BatchSolver::onSolve, this);
  spinner_.start();
}

void BatchSolver::take(const Measurement& z) {
  const std::lock_guard lock(mutex_);
  taken_.push_back(z);
}

void BatchSolver::reset() {
  const std::lock_guard lock(mutex_);
  taken_.clear();
  anew_ = true;
}

void BatchSolver::receive() {
  std::vector<Measurement> fresh;
  {
    const std::lock_guard lock(mutex_);
    fresh.swap(taken_);
    if (std::exchange(anew_, false)) {
      estimator_->reset();
      publisher_.clear();
    }
  }
  towfish::Output refused;
  for (const auto& z : fresh) estimator_->process(z, refused);
  publisher_.queue(refused);
}

bool BatchSolver::onSolve(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  receive();
  const ros::WallTime begin = ros::WallTime::now();
  towfish::Output output;
  estimator_->finish(output);
  const double seconds = (ros::WallTime::now() - begin).toSec();
  const std::size_t states = output.estimates.size();
  publisher_.queue(output);
  while (ros::ok() && !publisher_.nothingQueued()) {
    publisher_.publishSettled(kBurst, settings_);
    ros::WallDuration(kBetweenBursts).sleep();
  }
  response.success = states > 0;
  response.message =
      states > 0 ? fmt::format("{} states in {:.2f} s", states, seconds) : "nothing solved: " + estimator_->failure();
  return true;
}

}  // namespace sas_motion::ros_side
