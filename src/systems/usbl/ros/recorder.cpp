// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/recorder.hpp"

#include <nav_msgs/Odometry.h>
#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <cmath>
#include <string>

namespace sas_motion {

using namespace ros_side;

namespace {

constexpr double kTruthRate = 1;                             // [1/s]
constexpr double kGnssPhase = 0.13, kAttitudePhase = 0.017;  // of their first message after the start [s]
constexpr std::uint32_t kTransponder = 1;                    // id
constexpr const char* kArrayFrame = "usbl_link";

/// Events at a steady rate.
struct Clock {
  double phase, rate;
  long ticks = 0;
  double next() const { return phase + static_cast<double>(ticks) / rate; }
};

}  // namespace

UsblRecorder::UsblRecorder(const usbl::Scenario& scenario, std::uint64_t seed, BagOutput& bag)
    : scenario_(scenario), vessel_(scenario), simulator_(scenario, seed), bag_(bag) {}

void UsblRecorder::record(const std::function<void(double)>& progress) {
  enum { kPing, kFix, kAttitude, kTruth, kClocks };
  std::array<Clock, kClocks> clocks{Clock{1 / scenario_.ping_rate, scenario_.ping_rate},
                                    Clock{kGnssPhase, scenario_.gnss_rate},
                                    Clock{kAttitudePhase, scenario_.attitude_rate}, Clock{0, kTruthRate}};
  fixed();
  for (;;) {
    const auto clock = std::min_element(clocks.begin(), clocks.end(),
                                        [](const Clock& a, const Clock& b) { return a.next() < b.next(); });
    const double seconds = clock->next();
    if (seconds > scenario_.duration + 1e-9) return;
    ++clock->ticks;
    const usbl::Pose pose = vessel_.at(seconds);
    const ros::Time time = timeOf(usbl::kScenarioStart + stampFromSeconds(seconds));
    switch (clock - clocks.begin()) {
      case kPing: ping(time, seconds, pose); break;
      case kFix: fix(time, pose); break;
      case kAttitude: attitude(time, pose); break;
      default: truth(time, pose); progress(1 / kTruthRate);
    }
  }
}

void UsblRecorder::fixed() {
  const ros::Time start = timeOf(usbl::kScenarioStart);
  Transform T_base_gnss = Transform::Identity();
  T_base_gnss.translation() = bodyFromRosBody().transpose() * scenario_.gnss_lever_arm_body;
  tf2_msgs::TFMessage transforms;
  transforms.transforms = {stamped(settings_.base_frame, "gnss_link", start, T_base_gnss),
                           stamped(settings_.base_frame, "imu_link", start, Transform::Identity())};
  bag_.writeLatched("/tf_static", start, transforms);
  bag_.writeLatched(settings_.transponder_topic, start,
                    fixAt(simulator_.transponder(), start, std::to_string(kTransponder), Vector<3>::Zero()));
  const Transform T_base_array = transformOf(usbl::corrected({}, scenario_.truth.head<usbl::kStates>()));
  bag_.writeLatched("truth/usbl_mounting", start, stamped(settings_.base_frame, kArrayFrame, start, T_base_array));
}

void UsblRecorder::truth(ros::Time time, const usbl::Pose& pose) {
  nav_msgs::Odometry message;
  message.header.stamp = time;
  message.header.frame_id = "map";
  message.child_frame_id = settings_.base_frame;
  set(message.pose.pose.position, pose.position_map);
  message.pose.pose.orientation = messageOf(orientationOf(rotationOf(pose.attitude)));
  bag_.write("truth/odometry", time, message);
}

void UsblRecorder::fix(ros::Time time, const usbl::Pose& pose) {
  const double flat = scenario_.gnss_sigma * scenario_.gnss_sigma,
               up = scenario_.gnss_sigma_up * scenario_.gnss_sigma_up;
  const Geodetic antenna = simulator_.frame().geodetic(simulator_.measuredAntenna(pose));
  bag_.write(settings_.fix_topic, time, fixAt(antenna, time, "gnss_link", {flat, flat, up}));
}

void UsblRecorder::attitude(ros::Time time, const usbl::Pose& pose) {
  sensor_msgs::Imu message;
  message.header.stamp = time;
  message.header.frame_id = "imu_link";
  message.orientation = messageOf(orientationOf(rotationOf(simulator_.measuredAttitude(pose).attitude)));
  const double tilt = scenario_.attitude_sigma * scenario_.attitude_sigma,
               heading = scenario_.heading_sigma * scenario_.heading_sigma;
  message.orientation_covariance = {tilt, 0, 0, 0, tilt, 0, 0, 0, heading};
  message.angular_velocity_covariance[0] = message.linear_acceleration_covariance[0] = -1;
  bag_.write(settings_.imu_topic, time, message);
}

void UsblRecorder::ping(ros::Time time, double seconds, const usbl::Pose& pose) {
  const auto labelled = simulator_.ping(seconds, pose);
  if (!labelled) return;
  sas_motion::UsblMeasurement message = measurementOf(labelled->ping.reading);
  message.header.stamp = time;
  message.header.frame_id = kArrayFrame;
  message.transponder_id = kTransponder;
  bag_.write(settings_.measurement_topic, time, message);
  const auto& outlier = labelled->outlier;
  sas_motion::MeasurementLabel label;
  label.header.stamp = time;
  label.sensor = "usbl";
  label.outlier = {outlier[0], outlier[2], outlier[1]};  // in the order of the message: range, direction_x, direction_y
  bag_.write("truth/label", time, label);
}

}  // namespace sas_motion
