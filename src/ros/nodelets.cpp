// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "ros/estimator_server.hpp"
#include "ros/ins_server.hpp"
#include "systems/usbl/ros/calibration_server.hpp"

namespace sas_motion {
namespace {

/// Starts a server; wrong parameters stop it with one plain sentence instead of an exception in the manager.
template <class Server, class... Arguments>
std::unique_ptr<Server> serve(const ros::NodeHandle& node, const ros::NodeHandle& own, const Arguments&... arguments) {
  try {
    return std::make_unique<Server>(node, own, arguments...);
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", own.getNamespace().c_str(), error.what());
    throw;
  }
}

}  // namespace

/// Filters, live: by default kf and robust_kf side by side.
class FilterNodelet final : public nodelet::Nodelet {
  void onInit() override {
    server_ = serve<ros_side::EstimatorServer>(getNodeHandle(), getPrivateNodeHandle(),
                                               std::vector<std::string>{"kf", "robust_kf"});
  }
  std::unique_ptr<ros_side::EstimatorServer> server_;
};

/// The factor-graph smoother, live: fixed_lag, and batch on request (~batch: true, ~solve_batch).
class SmootherNodelet final : public nodelet::Nodelet {
  void onInit() override {
    server_ = serve<ros_side::EstimatorServer>(getNodeHandle(), getPrivateNodeHandle(),
                                               std::vector<std::string>{"fixed_lag"});
  }
  std::unique_ptr<ros_side::EstimatorServer> server_;
};

/// The fusion of INS, GPS and DVL in 27 states, live: by default robust_ckf27.
class InsFilterNodelet final : public nodelet::Nodelet {
  void onInit() override { server_ = serve<ros_side::InsServer>(getNodeHandle(), getPrivateNodeHandle()); }
  std::unique_ptr<ros_side::InsServer> server_;
};

/// A USBL calibration, live.
class UsblCalibrationNodelet final : public nodelet::Nodelet {
  void onInit() override { server_ = serve<ros_side::CalibrationServer>(getNodeHandle(), getPrivateNodeHandle()); }
  std::unique_ptr<ros_side::CalibrationServer> server_;
};

}  // namespace sas_motion

PLUGINLIB_EXPORT_CLASS(sas_motion::FilterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(sas_motion::SmootherNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(sas_motion::InsFilterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(sas_motion::UsblCalibrationNodelet, nodelet::Nodelet)
