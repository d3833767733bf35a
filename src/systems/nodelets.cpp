// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "ros/server.hpp"
#include "systems/registry.hpp"
#include "systems/usbl/ros/calibration_server.hpp"

namespace sas_motion {
namespace {

using ros_side::EstimatorServer;

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

EstimatorServer::Open systemOr(const char* otherwise) {
  return [otherwise](const std::string& config) { return openSystem(config, otherwise); };
}

}  // namespace

/// Filters of the system of ~config, live; without a file a towfish's, by default kf and robust_kf side by side.
class FilterNodelet final : public nodelet::Nodelet {
  void onInit() override {
    server_ = serve<EstimatorServer>(getNodeHandle(), getPrivateNodeHandle(), systemOr("towfish"),
                                     EstimatorServer::Kind::Filters);
  }
  std::unique_ptr<EstimatorServer> server_;
};

/// The factor-graph smoother, live: fixed_lag, and batch on request (~batch: true, ~solve_batch).
class SmootherNodelet final : public nodelet::Nodelet {
  void onInit() override {
    server_ = serve<EstimatorServer>(getNodeHandle(), getPrivateNodeHandle(), systemOr("towfish"),
                                     EstimatorServer::Kind::Smoothers);
  }
  std::unique_ptr<EstimatorServer> server_;
};

/// Filters of the system of ~config, live; without a file the fusion of INS, GNSS and DVL in 27 states.
class InsFilterNodelet final : public nodelet::Nodelet {
  void onInit() override {
    server_ = serve<EstimatorServer>(getNodeHandle(), getPrivateNodeHandle(), systemOr("ins_gps_dvl"),
                                     EstimatorServer::Kind::Filters);
  }
  std::unique_ptr<EstimatorServer> server_;
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
