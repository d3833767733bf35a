// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "systems/ins_gps_dvl/graph/interval.hpp"

namespace sas_motion::ins {

/// Cuts a run into nodes as it comes: one at each reading of a sensor that aids, and where the last is long ago.
/// Iterations start from robust_kf27, which runs beside.
class InsChain {
 public:
  /// A node with what was read at it and on the way into it. A node that stands already comes again where readings of
  /// its stamp come later.
  struct Stop {
    Stamp stamp = 0;
    Node start;
    Vector<3> rate_body = Vector<3>::Zero();  ///< of the body against inertial space
    std::vector<Aiding> readings;
    std::shared_ptr<const InertialInterval> way;  ///< from the node before; none into the first
  };

  InsChain(const Config& config, const NavigationState& start, Stamp stamp);

  void add(const Aiding& reading) {
    filter_.add(reading);
    waiting_.push_back(reading);
  }
  /// Appends what is refused to `audits`, and nodes that are complete to `stops`.
  ImuVerdict add(const ImuReading& reading, std::vector<Audit>& audits, std::vector<Stop>& stops);
  /// Ends at the last stamp of the IMU.
  void close(std::vector<Stop>& stops);

  const RobustKf27& filter() const { return filter_; }

 private:
  void advance(const ImuReading& reading, Stamp stamp);
  void cut(std::vector<Stop>& stops);
  Stop stopHere() const;

  RobustKf27 filter_;
  Mechanisation ins_;
  std::vector<Aiding> waiting_;
  double gap_ = 0;  // of the reading that is integrated, where it bridges one [s]
  Stop stop_;       // the last node, which may still get readings
  InertialInterval way_;
};

}  // namespace sas_motion::ins
