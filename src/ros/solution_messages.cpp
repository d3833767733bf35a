// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/solution_messages.hpp"

#include <algorithm>

namespace sas_motion::ros_side {
namespace {

template <int N>
using RowMajor = Eigen::Matrix<double, N, N, Eigen::RowMajor>;

/// Copies a matrix into a message's row-major field, and back.
template <int N, class Field>
void fill(Field& field, const Matrix<N>& matrix) {
  Eigen::Map<RowMajor<N>>(field.data()) = matrix;
}
template <int N, class Field>
Matrix<N> matrixOf(const Field& field) {
  return Eigen::Map<const RowMajor<N>>(field.data());
}

}  // namespace

nav_msgs::Odometry odometryOf(const Solution& solution, const MapSettings& settings) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = timeOf(solution.stamp);
  odometry.header.frame_id = settings.map_frame;
  odometry.child_frame_id = settings.base_frame;
  set(odometry.pose.pose.position, solution.position_map);
  odometry.pose.pose.orientation = messageOf(solution.q_map_base);
  set(odometry.twist.twist.linear, solution.velocity_base);
  set(odometry.twist.twist.angular, solution.rate_base);
  fill<6>(odometry.pose.covariance, solution.pose_covariance);
  fill<6>(odometry.twist.covariance, solution.twist_covariance);
  return odometry;
}

Solution solutionOf(const nav_msgs::Odometry& odometry) {
  Solution solution;
  solution.stamp = stampOf(odometry.header.stamp);
  const auto& p = odometry.pose.pose.position;
  solution.position_map << p.x, p.y, p.z;
  solution.q_map_base = quaternionOf(odometry.pose.pose.orientation);
  solution.velocity_base = vectorOf(odometry.twist.twist.linear);
  solution.rate_base = vectorOf(odometry.twist.twist.angular);
  solution.pose_covariance = matrixOf<6>(odometry.pose.covariance);
  solution.twist_covariance = matrixOf<6>(odometry.twist.covariance);
  return solution;
}

geometry_msgs::TwistWithCovarianceStamped currentOf(const Solution& solution, const MapSettings& settings) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header.stamp = timeOf(solution.stamp);
  message.header.frame_id = settings.map_frame;
  message.twist.twist.linear.x = solution.current->velocity_map.x();
  message.twist.twist.linear.y = solution.current->velocity_map.y();
  Matrix<6> P = Matrix<6>::Zero();
  P.topLeftCorner<2, 2>() = solution.current->covariance;
  P.diagonal().tail<4>().setConstant(kNotEstimated);
  fill<6>(message.twist.covariance, P);
  return message;
}

Current currentOf(const geometry_msgs::TwistWithCovarianceStamped& message) {
  const auto& v = message.twist.twist.linear;
  return {{v.x, v.y}, matrixOf<6>(message.twist.covariance).topLeftCorner<2, 2>()};
}

sensor_msgs::NavSatFix fixOf(const Solution& solution, const MapSettings& settings) {
  sensor_msgs::NavSatFix fix = fixAt(*solution.place, timeOf(solution.stamp), settings.base_frame);
  if (!solution.place_covariance) return fix;
  fill<3>(fix.position_covariance, *solution.place_covariance);
  fix.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_KNOWN;
  return fix;
}

sas_motion::FilterUpdate updateOf(const Audit& audit) {
  sas_motion::FilterUpdate update;
  update.header.stamp = timeOf(audit.stamp);
  update.sensor = audit.sensor;
  update.innovation.assign(audit.innovation.data(), audit.innovation.data() + audit.rows);
  update.weights.assign(audit.weights.data(), audit.weights.data() + audit.rows);
  for (int row = 0; row < audit.rows; ++row)
    for (int col = 0; col < audit.rows; ++col) update.innovation_covariance.push_back(audit.S(row, col));
  update.nis = audit.nis;
  update.verdict = static_cast<std::uint8_t>(audit.verdict);
  update.reason = audit.reason;
  update.iterations = static_cast<std::uint32_t>(audit.iterations);
  update.effective_size = audit.effective_size;
  if (audit.hypotheses[0] > 0) update.hypotheses.assign(audit.hypotheses.begin(), audit.hypotheses.end());
  return update;
}

Audit auditOf(const sas_motion::FilterUpdate& update, std::string_view sensor) {
  Audit audit{stampOf(update.header.stamp), sensor};
  const std::size_t rows = std::min<std::size_t>(update.weights.size(), kMostRows);
  audit.rows = static_cast<int>(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    audit.weights(at) = update.weights[row];
    if (row < update.innovation.size()) audit.innovation(at) = update.innovation[row];
    for (std::size_t col = 0; col < rows && update.innovation_covariance.size() == rows * rows; ++col)
      audit.S(at, static_cast<Eigen::Index>(col)) = update.innovation_covariance[row * rows + col];
  }
  audit.nis = update.nis;
  audit.verdict = static_cast<Verdict>(std::min<std::uint8_t>(update.verdict, 4));
  audit.iterations = static_cast<int>(update.iterations);
  audit.effective_size = update.effective_size;
  std::copy_n(update.hypotheses.begin(), std::min(update.hypotheses.size(), audit.hypotheses.size()),
              audit.hypotheses.begin());
  return audit;
}

}  // namespace sas_motion::ros_side
