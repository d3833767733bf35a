// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/recorder.hpp"

#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ros/solution_messages.hpp"
#include "sas_motion/systems/towfish/solution.hpp"

namespace sas_motion {

using namespace ros_side;
using namespace towfish;

namespace {

constexpr double kTruthPeriod = 0.1;  // between messages of the truth [s]

sas_motion::MeasurementLabel label(const Measurement& z, const std::array<bool, 2>& outlier) {
  sas_motion::MeasurementLabel message;
  message.header.stamp = timeOf(z.stamp);
  message.sensor = sensorName(z.sensor);
  message.outlier.assign(outlier.begin(), outlier.begin() + rowsOf(z.sensor));
  return message;
}

}  // namespace

void TowfishRecorder::record(const std::function<void(double)>& progress) {
  const long every = std::max(1L, std::lround(kTruthPeriod / scenario_.step));
  transforms();
  for (long step = 0; simulator_.next(); ++step) {
    if (step % every == 0) truth(simulator_.truth());
    measurements(simulator_.measurements());
    if (step % 100 == 0) progress(100 * scenario_.step);
  }
}

void TowfishRecorder::transforms() {
  const ros::Time time = timeOf(Simulator::kStart);
  Transform T_base_gnss = Transform::Identity();
  T_base_gnss.translation() << scenario_.gnss_lever_arm_body(0), -scenario_.gnss_lever_arm_body(1), 0;
  tf2_msgs::TFMessage message;
  message.transforms = {stamped(settings_.base_frame, "gnss_link", time, T_base_gnss),
                        stamped(settings_.base_frame, "imu_link", time, Transform::Identity()),
                        stamped(settings_.base_frame, "dvl_link", time, Transform::Identity())};
  bag_.writeLatched("/tf_static", time, message);
}

void TowfishRecorder::truth(const TruthSample& truth) {
  const Solution exact = solutionOf({truth.stamp, {truth.state, StateMatrix::Zero()}}, &frame_);
  const ros::Time time = timeOf(truth.stamp);
  bag_.write("truth/odometry", time, odometryOf(exact, settings_));
  bag_.write("truth/fix", time, fixOf(exact, settings_));
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
    if (z.sensor == Sensor::Velocity) bag_.write("dvl/velocity", time, twist(z));
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
  sensor_msgs::NavSatFix message = fixAt(frame_.geodetic({z.value(1), z.value(0), 0}), timeOf(z.stamp), "gnss_link",
                                         {z.variance(1), z.variance(0), 4 * z.variance(0)});
  message.header.seq = fix_seq_++;
  return message;
}

geometry_msgs::TwistWithCovarianceStamped TowfishRecorder::twist(const Measurement& z) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header.seq = twist_seq_++;
  message.header.stamp = timeOf(z.stamp);
  message.header.frame_id = "dvl_link";
  const std::size_t rows = static_cast<std::size_t>(rowsOf(z.sensor));
  message.twist.twist.linear.x = z.value(0);
  message.twist.twist.linear.y = rows > 1 ? -z.value(1) : 0;
  for (std::size_t i = 0; i < 6; ++i) message.twist.covariance[7 * i] = i < rows ? z.variance(0) : 1e6;
  return message;
}

void TowfishRecorder::fill(sensor_msgs::Imu& imu, const Measurement& z) const {
  imu.header.stamp = timeOf(z.stamp);
  imu.header.frame_id = "imu_link";
  if (z.sensor == Sensor::Heading) {
    Estimate at{z.stamp, {}};
    at.belief.mean(kHeading) = z.value(0);
    imu.orientation = messageOf(solutionOf(at, nullptr).q_map_base);
    imu.orientation_covariance = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, z.variance(0)};
  } else {
    imu.angular_velocity.z = -z.value(0);
    imu.angular_velocity_covariance = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, z.variance(0)};
  }
}

}  // namespace sas_motion
