// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/recording.hpp"

#include <fmt/format.h>
#include <sas_motion/MeasurementLabel.h>

#include <algorithm>
#include <stdexcept>

#include "bag/answer_topics.hpp"
#include "ros/solution_messages.hpp"

namespace sas_motion::ros_side {
namespace {

using Twist = geometry_msgs::TwistWithCovarianceStamped;

/// Solutions and their currents as they come, before they are joined by stamp.
struct Parts {
  std::vector<Solution> solutions;
  std::map<Stamp, Current> currents;

  /// In time order.
  std::vector<Solution> joined() && {
    std::stable_sort(solutions.begin(), solutions.end(),
                     [](const Solution& a, const Solution& b) { return a.stamp < b.stamp; });
    for (auto& solution : solutions)
      if (const auto current = currents.find(solution.stamp); current != currents.end())
        solution.current = current->second;
    return std::move(solutions);
  }
};

/// A bag's messages, sorted by what they are of.
struct Contents {
  std::map<std::string, Parts> estimators;
  std::map<Stamp, Geodetic> true_fixes, fixes;
  std::map<Stamp, Solution> true_odometry;
  std::map<Stamp, Current> true_currents;
  std::optional<LocalFrame> datum;
};

/// Truth is where a true fix is; the rest of it comes from an odometry of the same stamp, where there is one.
TrueTrack truthOf(Contents& contents) {
  Parts parts{{}, std::move(contents.true_currents)};
  for (const auto& [stamp, place] : contents.true_fixes) {
    Solution point;
    point.stamp = stamp;
    point.pose_covariance.diagonal().tail<4>().setConstant(kNotEstimated);
    point.twist_covariance.diagonal().setConstant(kNotEstimated);
    if (const auto odometry = contents.true_odometry.find(stamp); odometry != contents.true_odometry.end())
      point = odometry->second;
    point.position_map = contents.datum->position_enu(place);
    parts.solutions.push_back(point);
  }
  return TrueTrack(std::move(parts).joined());
}

void readEstimator(const std::string& name, const std::set<std::string>& odometry, TopicReader& reader,
                   Contents& contents, Recording& recording) {
  Parts& parts = contents.estimators[name];
  RecordedEstimator& estimator = recording.estimators[name];
  const std::string topic = solutionTopic(odometry, name);
  reader.on<nav_msgs::Odometry>(topic, [&](const auto& m) { parts.solutions.push_back(solutionOf(m)); });
  reader.on<Twist>(nameBefore("settled", topic).empty() ? name + "/current" : name + "/settled_current",
                   [&](const auto& m) { parts.currents[stampOf(m.header.stamp)] = currentOf(m); });
  reader.on<sas_motion::FilterUpdate>(name + "/update", [&](const auto& m) {
    Audit audit = auditOf(m, *recording.sensors.insert(m.sensor).first);
    if (!(audit.S(0, 0) > 0)) audit.nis = 0;
    estimator.audits.push_back(audit);
  });
}

void readTruth(TopicReader& reader, Contents& contents, Recording& recording) {
  reader.on<sensor_msgs::NavSatFix>("datum", [&](const auto& m) {
    if (!contents.datum) contents.datum.emplace(geodeticOf(m));
  });
  reader.on<sensor_msgs::NavSatFix>("truth/fix", [&](const auto& m) {
    if (hasPosition(m)) contents.true_fixes[stampOf(m.header.stamp)] = geodeticOf(m);
  });
  reader.on<nav_msgs::Odometry>(
      "truth/odometry", [&](const auto& m) { contents.true_odometry[stampOf(m.header.stamp)] = solutionOf(m); });
  reader.on<Twist>("truth/current",
                   [&](const auto& m) { contents.true_currents[stampOf(m.header.stamp)] = currentOf(m); });
  reader.on<sas_motion::MeasurementLabel>("truth/label", [&](const auto& m) {
    recording.outliers[m.sensor][stampOf(m.header.stamp)] =
        std::any_of(m.outlier.begin(), m.outlier.end(), [](bool row) { return row; });
  });
}

/// Of all topics called fix that are no estimator's.
void readFixes(const BagReader& bag, TopicReader& reader, Contents& contents) {
  for (const auto& topic : topicsOf(bag, "sensor_msgs/NavSatFix")) {
    const std::string name = nameBefore("fix", topic);
    if (name == "truth" || contents.estimators.count(name) || (name.empty() && topic != "fix")) continue;
    reader.on<sensor_msgs::NavSatFix>(topic, [&](const auto& m) {
      if (hasPosition(m)) contents.fixes[stampOf(m.header.stamp)] = geodeticOf(m);
    });
  }
}

}  // namespace

Recording Recording::read(const std::string& file) {
  BagReader bag(file);
  TopicReader reader(bag);
  Recording recording;
  Contents contents;
  const auto odometry = topicsOf(bag, "nav_msgs/Odometry");
  for (const auto& topic : topicsOf(bag, "sas_motion/FilterUpdate"))
    if (const std::string name = nameBefore("update", topic); !name.empty())
      readEstimator(name, odometry, reader, contents, recording);
  if (recording.estimators.empty())
    throw std::runtime_error(
        fmt::format("{}: holds no estimates (no topic NAME/update); run reprocess on it or record the nodelets", file));
  readTruth(reader, contents, recording);
  readFixes(bag, reader, contents);
  reader.read();
  if (contents.true_fixes.empty())
    throw std::runtime_error(fmt::format("{}: no topic truth/fix; there is nothing to score against", file));
  if (!contents.datum)
    throw std::runtime_error(fmt::format("{}: no topic datum; the estimates' origin is unknown", file));

  recording.truth_topic = contents.true_odometry.empty() ? "truth/fix" : "truth/odometry";
  recording.truth = truthOf(contents);
  for (const auto& [stamp, place] : contents.fixes)
    recording.fixes.push_back({stamp, contents.datum->position_enu(place)});
  for (auto& [name, parts] : contents.estimators) recording.estimators[name].solutions = std::move(parts).joined();
  return recording;
}

std::optional<bool> Recording::outlier(std::string_view sensor, Stamp stamp) const {
  const auto labels = outliers.find(sensor);
  if (labels == outliers.end()) return std::nullopt;
  const auto label = labels->second.find(stamp);
  return label == labels->second.end() ? std::nullopt : std::optional(label->second);
}

}  // namespace sas_motion::ros_side
