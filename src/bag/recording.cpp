// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/recording.hpp"

#include <fmt/format.h>
#include <sas_motion/MeasurementLabel.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "bag/bag_reader.hpp"
#include "bag/topics.hpp"
#include "ros/solution_messages.hpp"

namespace sas_motion::ros_side {
namespace {

using namespace towfish;

constexpr double kLongestGap = 5;      // between two truths, that is interpolated over [s]

double headingOf(const geometry_msgs::Quaternion& q) {
  const double yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  return wrapAngle(kPi / 2 - yaw);
}

/// The state group by group, as far as an odometry message has it; covariances between groups that no message carries
/// are zero.
Estimate estimateOf(const nav_msgs::Odometry& odometry) {
  Estimate estimate;
  estimate.stamp = stampOf(odometry.header.stamp);
  auto& x = estimate.belief.mean;
  auto& P = estimate.belief.covariance;
  P.setIdentity();
  x << odometry.pose.pose.position.y, odometry.pose.pose.position.x, 0, 0, headingOf(odometry.pose.pose.orientation),
      odometry.twist.twist.linear.x;
  const auto& c = odometry.pose.covariance;
  P(kNorth, kNorth) = c[7];
  P(kEast, kEast) = c[0];
  P(kNorth, kEast) = P(kEast, kNorth) = c[1];
  P(kHeading, kHeading) = c[35];
  P(kSpeed, kSpeed) = odometry.twist.covariance[0];
  return estimate;
}

void addCurrent(const geometry_msgs::TwistWithCovarianceStamped& current, Gaussian<kStates>& belief) {
  belief.mean(kCurrentNorth) = current.twist.twist.linear.y;
  belief.mean(kCurrentEast) = current.twist.twist.linear.x;
  const auto& c = current.twist.covariance;
  belief.covariance(kCurrentNorth, kCurrentNorth) = c[7];
  belief.covariance(kCurrentEast, kCurrentEast) = c[0];
  belief.covariance(kCurrentNorth, kCurrentEast) = belief.covariance(kCurrentEast, kCurrentNorth) = c[1];
}

/// In six degrees of freedom, where the message has them.
std::optional<MotionSample> motionOf(const nav_msgs::Odometry& odometry) {
  const auto& pose = odometry.pose;
  if (pose.covariance[14] >= kNotEstimated) return std::nullopt;
  MotionSample motion;
  motion.stamp = stampOf(odometry.header.stamp);
  motion.position_map << pose.pose.position.x, pose.pose.position.y, pose.pose.position.z;
  const auto& q = pose.pose.orientation;
  motion.q_map_base = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  const auto& v = odometry.twist.twist.linear;
  motion.velocity_base << v.x, v.y, v.z;
  motion.lying = pose.covariance[21] < kNotEstimated;
  motion.moving = odometry.twist.covariance[0] < kNotEstimated;
  const auto block = [](const auto& covariance, int first) -> std::optional<Matrix<3>> {
    const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> P =
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(covariance.data());
    if (!(P(first, first) > 0)) return std::nullopt;  // zero is unknown
    return P.block<3, 3>(first, first);
  };
  motion.P_position_map = block(pose.covariance, 0);
  motion.P_rotation_map = block(pose.covariance, 3);
  motion.P_velocity_base = block(odometry.twist.covariance, 0);
  return motion;
}

RecordedAudit auditOf(const sas_motion::FilterUpdate& update) {
  RecordedAudit audit;
  audit.stamp = stampOf(update.header.stamp);
  audit.sensor = update.sensor;
  audit.rows = update.weights.size();
  for (const double weight : update.weights) audit.least_weight = std::min(audit.least_weight, weight);
  if (!update.innovation_covariance.empty() && update.innovation_covariance[0] > 0) audit.nis = update.nis;
  audit.effective_size = update.effective_size;
  audit.verdict = static_cast<Verdict>(std::min<std::uint8_t>(update.verdict, 4));
  return audit;
}

/// The estimators of a bag: those whose topic NAME/update is there.
std::set<std::string> estimatorsIn(const std::vector<BagConnection>& connections) {
  std::set<std::string> names;
  for (const auto& connection : connections) {
    const std::string topic = bareTopic(connection.topic);
    if (connection.type == "sas_motion/FilterUpdate" && topic.size() > 7 && topic.substr(topic.size() - 7) == "/update")
      names.insert(topic.substr(0, topic.size() - 7));
  }
  return names;
}

/// Truth as it comes, before its parts are joined by stamp.
struct TruthParts {
  std::map<Stamp, Geodetic> fixes;
  std::map<Stamp, nav_msgs::Odometry> odometry;
  std::map<Stamp, geometry_msgs::TwistWithCovarianceStamped> current;
};

std::vector<TruthPoint> join(const TruthParts& parts, const LocalFrame& frame) {
  std::vector<TruthPoint> truth;
  for (const auto& [stamp, point] : parts.fixes) {
    TruthPoint t;
    t.stamp = stamp;
    auto& reference = t.reference;
    reference.state.setZero();
    const auto odometry = parts.odometry.find(stamp);
    reference.heading_known = reference.speed_known = odometry != parts.odometry.end();
    if (reference.heading_known) {
      reference.state = estimateOf(odometry->second).belief.mean;
      t.motion = motionOf(odometry->second);
    }
    const auto current = parts.current.find(stamp);
    reference.current_known = current != parts.current.end();
    Gaussian<kStates> belief{reference.state, StateMatrix::Identity()};
    if (reference.current_known) addCurrent(current->second, belief);
    reference.state = belief.mean;
    const Vector<3> enu = frame.position_enu(point);
    reference.state(kNorth) = enu(1);
    reference.state(kEast) = enu(0);
    if (t.motion) t.motion->position_map = enu;
    truth.push_back(t);
  }
  return truth;
}

void sortByStamp(RecordedEstimator& estimator) {
  const auto earlier = [](const auto& a, const auto& b) { return a.stamp < b.stamp; };
  std::stable_sort(estimator.estimates.begin(), estimator.estimates.end(), earlier);
  std::stable_sort(estimator.motions.begin(), estimator.motions.end(), earlier);
}

}  // namespace

Recording Recording::read(const std::string& file) {
  BagReader bag(file);
  Recording recording;
  std::map<std::string, bool> settled;
  for (const auto& name : estimatorsIn(bag.connections())) recording.estimators[name];
  if (recording.estimators.empty())
    throw std::runtime_error(
        fmt::format("{}: holds no estimates (no topic NAME/update); run reprocess on it or record the nodelets", file));
  for (const auto& connection : bag.connections())
    for (const auto& [name, unused] : recording.estimators)
      if (bareTopic(connection.topic) == name + "/settled") settled[name] = true;

  TruthParts truth;
  std::optional<LocalFrame> frame;
  std::vector<std::pair<Stamp, Geodetic>> fixes;
  std::map<std::string, std::map<Stamp, geometry_msgs::TwistWithCovarianceStamped>> currents;
  nav_msgs::Odometry odometry;
  geometry_msgs::TwistWithCovarianceStamped current;
  sensor_msgs::NavSatFix fix;
  sas_motion::FilterUpdate update;
  sas_motion::MeasurementLabel label;
  while (const BagMessage* m = bag.next()) {
    const std::string topic = bareTopic(m->connection->topic);
    const auto slash = topic.rfind('/');
    const std::string name = slash == std::string::npos ? "" : topic.substr(0, slash),
                      leaf = slash == std::string::npos ? topic : topic.substr(slash + 1);
    if (const auto found = recording.estimators.find(name); found != recording.estimators.end()) {
      const bool has_settled = settled[name];
      if (leaf == (has_settled ? "settled" : "odometry") && bag.get(*m, odometry)) {
        found->second.estimates.push_back(estimateOf(odometry));
        if (const auto motion = motionOf(odometry)) found->second.motions.push_back(*motion);
      }
      if (leaf == "update" && bag.get(*m, update)) found->second.audits.push_back(auditOf(update));
      if (leaf == (has_settled ? "settled_current" : "current") && bag.get(*m, current))
        currents[name][stampOf(current.header.stamp)] = current;
    } else if (topic == "datum") {
      if (!frame && bag.get(*m, fix)) frame.emplace(geodeticOf(fix));
    } else if (topic == "truth/fix") {
      if (bag.get(*m, fix) && hasPosition(fix)) truth.fixes[stampOf(fix.header.stamp)] = geodeticOf(fix);
    } else if (topic == "truth/odometry") {
      if (bag.get(*m, odometry)) truth.odometry[stampOf(odometry.header.stamp)] = odometry;
    } else if (topic == "truth/current") {
      if (bag.get(*m, current)) truth.current[stampOf(current.header.stamp)] = current;
    } else if (topic == "truth/label") {
      if (bag.get(*m, label))
        recording.outlier[{stampOf(label.header.stamp), label.sensor}] =
            std::any_of(label.outlier.begin(), label.outlier.end(), [](bool b) { return b; });
    } else if (leaf == "fix") {
      if (bag.get(*m, fix) && hasPosition(fix)) fixes.emplace_back(stampOf(fix.header.stamp), geodeticOf(fix));
    }
  }
  if (truth.fixes.empty())
    throw std::runtime_error(fmt::format("{}: no topic truth/fix; there is nothing to score against", file));
  if (!frame) throw std::runtime_error(fmt::format("{}: no topic datum; the estimates' origin is unknown", file));

  recording.truth_topic = truth.odometry.empty() ? "truth/fix" : "truth/odometry";
  recording.truth = join(truth, *frame);
  recording.begin = recording.truth.front().stamp;
  recording.end = recording.truth.back().stamp;
  for (const auto& [stamp, point] : fixes) {
    const Vector<3> enu = frame->position_enu(point);
    recording.fixes.push_back({stamp, {enu(1), enu(0)}});
  }
  for (auto& [name, estimator] : recording.estimators) {
    sortByStamp(estimator);
    for (auto& estimate : estimator.estimates)
      if (const auto found = currents[name].find(estimate.stamp); found != currents[name].end())
        addCurrent(found->second, estimate.belief);
  }
  return recording;
}

std::optional<std::pair<const TruthPoint*, const TruthPoint*>> Recording::around(Stamp stamp) const {
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), stamp, [](const TruthPoint& t, Stamp s) { return t.stamp < s; });
  if (after == truth.end()) return std::nullopt;
  if (after->stamp == stamp) return std::pair(&*after, &*after);
  if (after == truth.begin() || secondsBetween((after - 1)->stamp, after->stamp) > kLongestGap) return std::nullopt;
  return std::pair(&*(after - 1), &*after);
}

std::optional<Reference> Recording::truthAt(Stamp stamp) const {
  const auto points = around(stamp);
  if (!points) return std::nullopt;
  const auto [a, b] = *points;
  Reference reference = a->reference;
  if (a == b) return reference;
  reference.state += secondsBetween(a->stamp, stamp) / secondsBetween(a->stamp, b->stamp) *
                     Model::difference(b->reference.state, a->reference.state);
  reference.state(kHeading) = wrapAngle(reference.state(kHeading));
  return reference;
}

std::optional<MotionSample> Recording::motionAt(Stamp stamp) const {
  const auto points = around(stamp);
  if (!points || !points->first->motion || !points->second->motion) return std::nullopt;
  return points->first == points->second ? points->first->motion
                                         : interpolate(*points->first->motion, *points->second->motion, stamp);
}

}  // namespace sas_motion::ros_side
