// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/ros/recorder.hpp"

#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/solution_messages.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/earth.hpp"

namespace sas_motion {

using namespace ros_side;
using namespace ins;

namespace {

constexpr Stamp kStart = 1'600'000'000 * kNanosecondsPerSecond;  // stamp of every scenario's beginning
constexpr double kTruthRate = 50;                                // [1/s]
constexpr double kUnstated = 1e6;                                // variance of what a message does not say
constexpr std::array<const char*, kSensors> kFrames{"gnss_link", "dvl_link", "depth_link"};  // by Sensor

Transform at(const Vector<3>& lever_body) {
  Transform T = Transform::Identity();
  T.translation() = bodyFromRosBody().transpose() * lever_body;
  return T;
}

boost::array<double, 9> diagonal(double x, double y, double z) { return {x, 0, 0, 0, y, 0, 0, 0, z}; }
double squared(double value) { return value * value; }

}  // namespace

InsRecorder::InsRecorder(const Scenario& scenario, std::uint64_t seed, BagOutput& bag)
    : InsRecorder(
          scenario, [&](const Trajectory& trajectory) { return simulate(scenario, trajectory, seed); }, true, bag) {}

InsRecorder::InsRecorder(const Scenario& scenario, const Simulate& simulate, bool with_gps, BagOutput& bag)
    : scenario_(scenario),
      trajectory_(scenario.track, scenario.duration),
      recording_(simulate(trajectory_)),
      with_gps_(with_gps),
      bag_(bag),
      frame_(scenario.track.start),
      T_base_dvl_(at(scenario.parameters.dvl_lever_body)),
      attitude_error_(recording_.start.q_nav_body * trajectory_.at(0).state.q_nav_body.conjugate()) {
  T_base_dvl_.rotate(Eigen::AngleAxisd(kPi / 4, Vector<3>::UnitZ()));
}

void InsRecorder::record(const std::function<void(double)>& progress) {
  transforms();
  truth(0);
  if (!with_gps_) start();
  auto next = recording_.aiding.begin();
  const long every = std::max(1L, std::lround(scenario_.imu_rate / kTruthRate));
  for (std::size_t k = 1; k < recording_.imu.size(); ++k) {  // the first has no interval
    const ImuReading& reading = recording_.imu[k];
    for (; next != recording_.aiding.end() && next->reading.stamp <= reading.stamp; ++next) aiding(*next);
    inertial(reading);
    if (static_cast<long>(k) % every == 0) truth(secondsBetween(0, reading.stamp));
    progress(1 / scenario_.imu_rate);
  }
}

/// The INS starts at the first attitude before a fix: here that of the first reading of its unit.
void InsRecorder::start() {
  const Stamp begin = recording_.imu.front().stamp, after = begin + stampFromSeconds(0.5 / scenario_.imu_rate);
  auto& seq = seq_[static_cast<std::size_t>(Sensor::Gps)];
  std::uint32_t first = 0;
  velocity(recording_.start.velocity_nav, header(begin, "", first));
  inertial(recording_.imu.front());
  Aiding reading;
  reading.fix = recording_.start;
  displace(reading.fix, secondsBetween(begin, after) * recording_.start.velocity_nav);
  reading.variance = scenario_.parameters.start_position.cwiseAbs2();
  fix(reading, header(after, kFrames[0], seq));
}

void InsRecorder::transforms() {
  const ros::Time time = timeOf(kStart);
  const auto of = [&](Sensor sensor, const Transform& T) {
    return stamped(settings_.base_frame, kFrames[static_cast<std::size_t>(sensor)], time, T);
  };
  tf2_msgs::TFMessage message;
  message.transforms = {stamped(settings_.base_frame, "imu_link", time, Transform::Identity()),
                        of(Sensor::Gps, at(scenario_.parameters.gps_lever_body)), of(Sensor::Dvl, T_base_dvl_),
                        of(Sensor::Depth, at(scenario_.parameters.depth_lever_body))};
  bag_.writeLatched("/tf_static", time, message);
}

void InsRecorder::truth(double seconds) {
  const TruthSample sample = trajectory_.at(seconds);
  NavigationSolution exact;
  exact.stamp = kStart + stampFromSeconds(seconds);
  exact.state = sample.state;
  exact.rate_body =
      sample.rateBody() - sample.state.q_nav_body.conjugate() * earth::rotationRate(sample.state.latitude);
  const ros::Time time = timeOf(exact.stamp);
  const Solution solution = solutionOf(exact, frame_);
  bag_.write("truth/odometry", time, odometryOf(solution, settings_));
  bag_.write("truth/fix", time, fixOf(solution, settings_));
}

std_msgs::Header InsRecorder::header(Stamp since_start, const char* frame, std::uint32_t& seq) const {
  std_msgs::Header header;
  header.seq = seq++;
  header.stamp = timeOf(kStart + since_start);
  header.frame_id = frame;
  return header;
}

void InsRecorder::inertial(const ImuReading& reading) {
  const Parameters& p = scenario_.parameters;
  sensor_msgs::Imu message;
  message.header = header(reading.stamp, "imu_link", imu_seq_);
  const Eigen::Quaterniond attitude =
      attitude_error_ * trajectory_.at(secondsBetween(0, reading.stamp)).state.q_nav_body;
  message.orientation = messageOf(orientationOf(attitude.toRotationMatrix()));
  message.orientation_covariance = diagonal(squared(p.start_tilt), squared(p.start_tilt), squared(p.start_heading));
  set(message.angular_velocity, bodyFromRosBody().transpose() * reading.rate_body);
  set(message.linear_acceleration, bodyFromRosBody().transpose() * reading.force_body);
  const double rate = squared(p.angle_random_walk) * scenario_.imu_rate,
               force = squared(p.velocity_random_walk) * scenario_.imu_rate;
  message.angular_velocity_covariance = diagonal(rate, rate, rate);
  message.linear_acceleration_covariance = diagonal(force, force, force);
  bag_.write("imu/data", message.header.stamp, message);
}

void InsRecorder::aiding(const LabelledAiding& labelled) {
  const Aiding& reading = labelled.reading;
  const auto sensor = static_cast<std::size_t>(reading.sensor);
  const std_msgs::Header of = header(reading.stamp, kFrames[sensor], seq_[sensor]);
  switch (reading.sensor) {
    case Sensor::Gps: fix(reading, of); break;
    case Sensor::Dvl: twist(reading, of); break;
    case Sensor::Depth: depth(reading, of); break;
    case Sensor::Dpc: return;  // there is no message for it
  }
  sas_motion::MeasurementLabel label;
  label.header.stamp = of.stamp;
  label.sensor = sensorName(reading.sensor);
  label.outlier.assign(labelled.outlier.begin(), labelled.outlier.begin() + rowsOf(reading.sensor));
  bag_.write("truth/label", of.stamp, label);
}

void InsRecorder::fix(const Aiding& reading, std_msgs::Header header) {
  const Vector<3> variance = reading.variance.value_or(scenario_.parameters.gps_white.cwiseAbs2());
  sensor_msgs::NavSatFix message = fixAt(geodeticOf(reading.fix), header.stamp, header.frame_id, variance);
  message.header = header;
  bag_.write("gnss/fix", header.stamp, message);
}

void InsRecorder::velocity(const Vector<3>& velocity_nav, std_msgs::Header header) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = header;
  message.header.frame_id = settings_.map_frame;
  set(message.twist.twist.linear, velocity_nav);
  for (std::size_t i = 0; i < 6; ++i)
    message.twist.covariance[7 * i] = i < 3 ? squared(scenario_.parameters.start_velocity) : kUnstated;
  bag_.write("gnss/velocity", header.stamp, message);
}

void InsRecorder::twist(const Aiding& reading, std_msgs::Header header) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = header;
  const Matrix<3> C_dvl_body = T_base_dvl_.linear().transpose() * bodyFromRosBody().transpose();
  set(message.twist.twist.linear, C_dvl_body * reading.velocity_body);
  const Vector<3> variance =
      C_dvl_body.cwiseAbs2() * reading.variance.value_or(scenario_.parameters.dvl_white.cwiseAbs2());
  for (int i = 0; i < 6; ++i)
    message.twist.covariance[static_cast<std::size_t>(7 * i)] = i < 3 ? variance(i) : kUnstated;
  bag_.write("dvl/twist", header.stamp, message);
}

void InsRecorder::depth(const Aiding& reading, std_msgs::Header header) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header = header;
  message.pose.pose.position.z = reading.fix.height;
  message.pose.pose.orientation.w = 1;
  for (std::size_t i = 0; i < 6; ++i)
    message.pose.covariance[7 * i] = i == 2 ? squared(scenario_.parameters.depth_white) : kUnstated;
  bag_.write("depth/pose", header.stamp, message);
}

}  // namespace sas_motion
