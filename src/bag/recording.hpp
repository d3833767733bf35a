// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

#include "evaluation/true_track.hpp"
#include "sas_motion/estimate/output.hpp"

namespace sas_motion::ros_side {

/// The answers of one estimator in a bag, in time order. An audit without a covariance of its innovation has no NIS.
struct RecordedEstimator {
  std::vector<Solution> solutions;
  std::vector<Audit> audits;
};

struct RecordedFix {
  Stamp stamp = 0;
  Vector<3> position_map = Vector<3>::Zero();
};

/// A bag with estimates, read back for evaluation. Positions are relative to its datum.
struct Recording {
  Recording() = default;
  Recording(Recording&&) = default;  // no copies: audits point to the names of their sensors

  std::string truth_topic;
  TrueTrack truth;
  std::vector<RecordedFix> fixes;
  std::map<std::string, RecordedEstimator> estimators;
  std::map<std::string, std::map<Stamp, bool>, std::less<>> outliers;  ///< the simulator's labels, by sensor
  std::set<std::string> sensors;                                       ///< names in audits

  Stamp begin() const { return truth.points().front().stamp; }
  Stamp end() const { return truth.points().back().stamp; }
  /// The label of a reading, where there is one.
  std::optional<bool> outlier(std::string_view sensor, Stamp stamp) const;

  /// Reads NAME/settled where there is one, else NAME/odometry, with its current and NAME/update; truth/fix with
  /// truth/odometry and truth/current. Throws std::runtime_error naming the file and the topic that is missing.
  static Recording read(const std::string& bag);
};

}  // namespace sas_motion::ros_side
