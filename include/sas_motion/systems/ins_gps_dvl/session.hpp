// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/session/output_rate.hpp"
#include "sas_motion/session/session.hpp"
#include "sas_motion/systems/ins_gps_dvl/head.hpp"

namespace sas_motion::ins {

/// A state of the base as a solution.
Solution solutionOf(const NavigationSolution& base, const LocalFrame& map);

/// Estimators of a system with an INS side by side, live or from a bag.
class NavigationSession final : public sas_motion::Session {
 public:
  /// `output_rate` is that of settled answers [1/s]; `live`: keep the present answers. Throws std::invalid_argument
  /// where the factory knows no such estimator.
  NavigationSession(const SessionOptions& options, const std::vector<std::string>& names, const EstimatorFactory& make,
                    double output_rate, bool live);

  void process(const Reading& reading);
  const EstimatorRun& run() const { return live_->run(); }

  void feed() override;
  std::size_t unfed() const override { return run().unfed(); }
  void finish() override;
  void reset() override;
  void takeSettled(std::size_t lane, const OutputFrame& frame, sas_motion::Output& output) override;
  std::optional<Solution> current(std::size_t lane, const OutputFrame& frame) const override;
  std::optional<Solution> at(std::size_t lane, const OutputFrame& frame, Stamp stamp) const override;
  std::string setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) override;
  void configure(const Tuning& tuning) override;
  LaneReport report(std::size_t lane) const override;
  bool positionsAreOfMap() const override { return false; }

 private:
  SessionOptions options_;
  EstimatorFactory make_;
  double output_rate_;
  bool keeps_present_;
  std::unique_ptr<LiveRun> live_;
  std::vector<OutputRate> settled_rates_;  // by lane
};

}  // namespace sas_motion::ins
