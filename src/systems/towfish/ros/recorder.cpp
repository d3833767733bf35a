// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/recorder.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <string>

namespace sas_motion {

using namespace ros_side;
using namespace towfish;

namespace {

sas_motion::MeasurementLabel label(const Measurement& z, const std::array<bool, 2>& outlier) {
  sas_motion::MeasurementLabel message;
  message.header.stamp = timeOf(z.stamp);
  message.sensor = sensorName(z.sensor);
  message.outlier.assign(outlier.begin(), outlier.begin() + rowsOf(z.sensor));
  return message;
}

}  // namespace

void TowfishRecorder::transforms() {
  tf2_msgs::TFMessage message;
  for (const char* frame : {"gnss_link", "imu_link", "dvl_link"}) {
    geometry_msgs::TransformStamped T;
    T.header.stamp = timeOf(Simulator::kStart);
    T.header.frame_id = settings_.base_frame;
    T.child_frame_id = frame;
    T.transform.rotation.w = 1;
    if (std::string(frame) == "gnss_link") {
      T.transform.translation.x = scenario_.gnss_lever_arm_body(0);
      T.transform.translation.y = -scenario_.gnss_lever_arm_body(1);
    }
    message.transforms.push_back(T);
  }
  bag_.writeLatched("/tf_static", timeOf(Simulator::kStart), message);
}

void TowfishRecorder::truth(const TruthSample& truth) {
  const Estimate exact{truth.stamp, {truth.state, StateMatrix::Zero()}};
  const ros::Time time = timeOf(truth.stamp);
  bag_.write("truth/odometry", time, odometryOf(exact, settings_));
  bag_.write("truth/fix", time, fixOf(exact, frame_, settings_));
  bag_.write("truth/current", time, currentOf(exact, settings_));
}

void TowfishRecorder::measurements(const std::vector<LabelledMeasurement>& measurements) {
  sensor_msgs::Imu imu;
  imu.orientation_covariance[0] = imu.angular_velocity_covariance[0] = imu.linear_acceleration_covariance[0] = -1;
  bool has_imu = false;
  for (const auto& [z, outlier, variance] : measurements) {
    const ros::Time time = timeOf(z.stamp);
    if (z.sensor == Sensor::Position) bag_.write("gnss/fix", time, fix(z));
    if (z.sensor == Sensor::Speed) bag_.write("dvl/twist", time, twist(z));
    if (z.sensor == Sensor::Heading || z.sensor == Sensor::TurnRate) {
      fill(imu, z);
      has_imu = true;
    }
    if (z.sensor != Sensor::TurnRate) bag_.write("truth/label", time, label(z, outlier));
  }
  if (has_imu) {
    imu.header.seq = imu_seq_++;
    bag_.write("imu/data", imu.header.stamp, imu);
  }
}

sensor_msgs::NavSatFix TowfishRecorder::fix(const Measurement& z) {
  Estimate at{z.stamp, {}};
  at.belief.mean << z.value, 0, 0, 0, 0;
  sensor_msgs::NavSatFix message = fixOf(at, frame_, settings_);
  message.header.seq = fix_seq_++;
  message.header.frame_id = "gnss_link";
  message.position_covariance = {z.variance(1), 0, 0, 0, z.variance(0), 0, 0, 0, 4 * z.variance(0)};
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  return message;
}

geometry_msgs::TwistWithCovarianceStamped TowfishRecorder::twist(const Measurement& z) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header.seq = twist_seq_++;
  message.header.stamp = timeOf(z.stamp);
  message.header.frame_id = "dvl_link";
  message.twist.twist.linear.x = z.value(0);
  for (std::size_t i = 0; i < 6; ++i) message.twist.covariance[7 * i] = i == 0 ? z.variance(0) : 1e6;
  return message;
}

void TowfishRecorder::fill(sensor_msgs::Imu& imu, const Measurement& z) const {
  imu.header.stamp = timeOf(z.stamp);
  imu.header.frame_id = "imu_link";
  if (z.sensor == Sensor::Heading) {
    Estimate at{z.stamp, {}};
    at.belief.mean(kHeading) = z.value(0);
    imu.orientation = odometryOf(at, settings_).pose.pose.orientation;
    imu.orientation_covariance = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, z.variance(0)};
  } else {
    imu.angular_velocity.z = -z.value(0);
    imu.angular_velocity_covariance = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, z.variance(0)};
  }
}

}  // namespace sas_motion
