// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"
#include "sas_motion/ros/conversions.hpp"

namespace sas_motion::ros_side {

/// A known position, and heading, speed and current where the bag has them. Speed is forward over ground here.
struct TruthPoint {
  Stamp stamp = 0;
  towfish::Reference reference;
};

/// What one estimator wrote into a bag. The speed of its states is forward over ground.
struct RecordedEstimator {
  std::vector<Estimate> estimates;
  std::vector<Audit> audits;
};

struct RecordedFix {
  Stamp stamp = 0;
  Vector<2> position = Vector<2>::Zero();  ///< north, east [m]
};

/// A bag with estimates, read back for evaluation. Positions are relative to its datum.
struct Recording {
  Stamp begin = 0, end = 0;
  std::string truth_topic;
  std::vector<TruthPoint> truth;  ///< in time order
  std::vector<RecordedFix> fixes;
  std::map<std::string, RecordedEstimator> estimators;
  std::map<std::pair<Stamp, std::string>, bool> outlier;  ///< the simulator's labels, by stamp and sensor
  bool labelled() const { return !outlier.empty(); }

  /// Reads NAME/settled where there is one, else NAME/odometry, with NAME/current and NAME/update; truth/fix with truth/odometry and
  /// truth/current. Throws std::runtime_error naming the file and the topic that is missing.
  static Recording read(const std::string& bag);

  /// Truth at a stamp by linear interpolation; nothing outside it or in a gap of more than a few seconds.
  std::optional<towfish::Reference> truthAt(Stamp stamp) const;
};

}  // namespace sas_motion::ros_side
