// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/recorder.hpp"

#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <set>
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
  message.sensor = sourceName(z);
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
  tf2_msgs::TFMessage message;
  std::set<std::string> frames;
  for (const auto& source : scenario_.sources) {
    if (!frames.insert(source.frame).second) continue;
    Transform T_base_sensor = Transform::Identity();
    T_base_sensor.translation() << source.lever_arm_body(0), 0 - source.lever_arm_body(1), 0;
    message.transforms.push_back(stamped(settings_.base_frame, source.frame, time, T_base_sensor));
  }
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
  std::map<std::string, sensor_msgs::Imu> imus;  // by topic: a heading and a turn rate of one IMU share a message
  for (const auto& [z, outlier, variance] : measurements) {
    const SimulatedSource& source = scenario_.sources[static_cast<std::size_t>(z.source)];
    const ros::Time time = timeOf(z.stamp);
    if (z.sensor == Sensor::Position) bag_.write(source.topic, time, fix(z, source));
    if (z.sensor == Sensor::Speed || z.sensor == Sensor::Velocity) bag_.write(source.topic, time, twist(z, source));
    if (z.sensor == Sensor::Heading || z.sensor == Sensor::TurnRate) fill(imus[source.topic], z, source);
    if (z.sensor != Sensor::TurnRate) bag_.write("truth/label", time, label(z, outlier));
  }
  for (auto& [topic, imu] : imus) {
    imu.header.seq = seq_[topic]++;
    bag_.write(topic, timeOf(measurements.front().z.stamp), imu);
  }
}

std_msgs::Header TowfishRecorder::header(const Measurement& z, const SimulatedSource& source) const {
  std_msgs::Header header;
  header.stamp = timeOf(z.stamp + stampFromSeconds(source.time_offset));
  header.frame_id = source.frame;
  return header;
}

sensor_msgs::NavSatFix TowfishRecorder::fix(const Measurement& z, const SimulatedSource& source) {
  sensor_msgs::NavSatFix message =
      fixAt(frame_.geodetic({z.value(1), z.value(0), 0}), {}, "", {z.variance(1), z.variance(0), 4 * z.variance(0)});
  message.header = header(z, source);
  message.header.seq = seq_[source.topic]++;
  return message;
}

geometry_msgs::TwistWithCovarianceStamped TowfishRecorder::twist(const Measurement& z, const SimulatedSource& source) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = header(z, source);
  message.header.seq = seq_[source.topic]++;
  const std::size_t rows = static_cast<std::size_t>(rowsOf(z.sensor));
  message.twist.twist.linear.x = z.value(0);
  message.twist.twist.linear.y = rows > 1 ? -z.value(1) : 0;
  for (std::size_t i = 0; i < 6; ++i) message.twist.covariance[7 * i] = i < rows ? z.variance(0) : 1e6;
  return message;
}

void TowfishRecorder::fill(sensor_msgs::Imu& imu, const Measurement& z, const SimulatedSource& source) const {
  if (imu.header.frame_id.empty())  // what it does not measure
    imu.orientation_covariance[0] = imu.angular_velocity_covariance[0] = imu.linear_acceleration_covariance[0] = -1;
  imu.header = header(z, source);
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
