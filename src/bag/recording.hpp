// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/evaluation/scores.hpp"
#include "sas_motion/evaluation/motion_scores.hpp"

namespace sas_motion::ros_side {

/// A known position, and heading, speed and current where the bag has them. Speed is forward over ground here.
struct TruthPoint {
  Stamp stamp = 0;
  towfish::Reference reference;
  std::optional<MotionSample> motion;  ///< where the truth has six degrees of freedom
};

/// An audit as a bag has it.
struct RecordedAudit {
  Stamp stamp = 0;
  std::string sensor;
  std::size_t rows = 0;
  double least_weight = 1;
  std::optional<double> nis;  ///< where the estimator has one
  Verdict verdict = Verdict::Accepted;
  double effective_size = 0;  ///< of particles, where there are some
};

/// What one estimator wrote into a bag. The speed of its states is forward over ground.
struct RecordedEstimator {
  std::vector<towfish::Estimate> estimates;
  std::vector<MotionSample> motions;  ///< beside the estimates, of an estimator of six degrees of freedom
  std::vector<RecordedAudit> audits;
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

  /// Reads NAME/settled where there is one, else NAME/odometry, with NAME/current and NAME/update; truth/fix with
  /// truth/odometry and truth/current. Throws std::runtime_error naming the file and the topic that is missing.
  static Recording read(const std::string& bag);

  /// Truth at a stamp by linear interpolation; nothing outside it or in a gap of more than a few seconds.
  std::optional<towfish::Reference> truthAt(Stamp stamp) const;
  std::optional<MotionSample> motionAt(Stamp stamp) const;

 private:
  /// The truths around a stamp, with nothing between them; the same one twice at its own stamp.
  std::optional<std::pair<const TruthPoint*, const TruthPoint*>> around(Stamp stamp) const;
};

}  // namespace sas_motion::ros_side
