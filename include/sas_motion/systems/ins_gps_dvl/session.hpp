// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/session/output_rate.hpp"
#include "sas_motion/session/session_of.hpp"
#include "sas_motion/systems/ins_gps_dvl/aligned_estimator.hpp"

namespace sas_motion::ins {

/// A state of the base as a solution.
Solution solutionOf(const NavigationSolution& base, const LocalFrame& map);

/// Estimators of a system with an INS side by side.
class NavigationSession final : public SessionOf<InOrder> {
 public:
  /// `output_rate` is that of settled answers [1/s]; for the rest see SessionOf.
  NavigationSession(const SessionOptions& options, const std::vector<std::string>& names, const EstimatorFactory& make,
                    double output_rate, bool live);

  /// The first lane's.
  const Alignment& alignment() const { return estimator(0).alignment(); }
  const InertialCounts& inertial() const { return estimator(0).inertial(); }
  /// How many readings of the IMU and velocities of GNSS were left out for this reason.
  std::uint64_t refused(Timeline<InOrder>::Queue::Refusal why) const { return timeline(0).refused(why); }

  void reset() override;
  LaneReport report(std::size_t lane) const override;
  std::string setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) override;
  bool positionsAreOfMap() const override { return false; }

 private:
  const AlignedEstimator& estimator(std::size_t lane) const {
    return static_cast<const AlignedEstimator&>(timeline(lane).settled());
  }
  std::optional<Solution> solution(const NavigationSolution& solution, const OutputFrame& frame) const override;
  std::optional<Solution> settledSolution(std::size_t lane, const NavigationSolution& solution,
                                          const OutputFrame& frame) override;

  double output_rate_;
  std::vector<OutputRate> settled_rates_;  // by lane
};

}  // namespace sas_motion::ins
