// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/towfish/solution.hpp"

namespace sas_motion::towfish {

/// Estimators of a towfish side by side. Each puts measurements into the order of time itself.
class TowfishSession final : public Session {
 public:
  /// Throws std::invalid_argument where the factory knows no such estimator.
  TowfishSession(const Config& config, const std::vector<std::string>& names, const EstimatorFactory& make);

  void process(const Measurement& z) { unfed_.push_back(z); }

  void feed() override;
  std::size_t unfed() const override { return unfed_.size(); }
  void finish() override;
  void reset() override;
  void takeSettled(std::size_t lane, const OutputFrame& frame, sas_motion::Output& output) override;
  std::optional<Solution> current(std::size_t lane, const OutputFrame& frame) const override;
  std::optional<Solution> at(std::size_t lane, const OutputFrame& frame, Stamp stamp) const override;
  std::string setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) override;
  void configure(const Tuning& tuning) override;
  LaneReport report(std::size_t lane) const override;
  bool positionsAreOfMap() const override { return true; }

 private:
  struct Lane {
    std::unique_ptr<Estimator> estimator;
    OutputOf<Estimate> output;
    LaneReport report;
  };

  Config config_;
  std::vector<Lane> lanes_;
  std::vector<Measurement> unfed_;
};

}  // namespace sas_motion::towfish
