// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "sas_motion/ros/estimator_server.hpp"

namespace sas_motion {
namespace {

/// Starts the server; wrong parameters stop it with one plain sentence instead of an exception in the manager.
std::unique_ptr<ros_side::EstimatorServer> serve(const ros::NodeHandle& node, const ros::NodeHandle& own, const std::vector<std::string>& estimators) {
  try {
    return std::make_unique<ros_side::EstimatorServer>(node, own, estimators);
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", own.getNamespace().c_str(), error.what());
    throw;
  }
}

}  // namespace

/// Filters, live: by default kf and robust_kf side by side.
class FilterNodelet final : public nodelet::Nodelet {
  void onInit() override { server_ = serve(getNodeHandle(), getPrivateNodeHandle(), {"kf", "robust_kf"}); }
  std::unique_ptr<ros_side::EstimatorServer> server_;
};

/// The factor-graph smoother, live: fixed_lag, and batch on request (~batch: true, ~solve_batch).
class SmootherNodelet final : public nodelet::Nodelet {
  void onInit() override { server_ = serve(getNodeHandle(), getPrivateNodeHandle(), {"fixed_lag"}); }
  std::unique_ptr<ros_side::EstimatorServer> server_;
};

}  // namespace sas_motion

PLUGINLIB_EXPORT_CLASS(sas_motion::FilterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(sas_motion::SmootherNodelet, nodelet::Nodelet)
