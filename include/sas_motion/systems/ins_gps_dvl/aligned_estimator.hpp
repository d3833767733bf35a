// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sas_motion/session/in_order.hpp"
#include "sas_motion/systems/ins_gps_dvl/alignment.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"

namespace sas_motion::ins {

/// What decides estimates beside the readings.
struct SessionOptions {
  Config config;  ///< its start's standard deviations and lever arms are those of the alignment, where it finds them
  AlignmentOptions alignment;
  double lag = 5;       ///< late readings are fused at their own time up to this age [s]
  double max_gap = 10;  ///< after a longer gap of the IMU estimators start anew [s]
};

/// What became of the readings of the IMU.
struct InertialCounts {
  std::array<std::uint64_t, kImuVerdicts> verdicts{};  ///< by ImuVerdict
  double longest_gap = 0, mean_period = 0;             ///< of the readings that were integrated [s]
};

// What a Timeline needs to know of a reading.
inline const char* invalidity(const Reading&, const Config&) { return nullptr; }
/// The audit of a reading that was not fused; those of the IMU have none.
inline std::optional<Audit> refusalOf(const Reading& reading, Verdict verdict, const char* reason) {
  const auto* aiding = std::get_if<Aiding>(&reading);
  return aiding ? std::optional(refusal(*aiding, verdict, reason)) : std::nullopt;
}

using InOrder = InOrderEstimator<Reading, NavigationSolution, Start, Config>;

/// An estimator that begins where the alignment finds a start, and again after the clock was set.
class AlignedEstimator final : public InOrder {
 public:
  /// `make` makes estimators of this name.
  AlignedEstimator(const SessionOptions& options, const std::string& name, EstimatorFactory make);
  AlignedEstimator(const AlignedEstimator& other);

  void process(const Reading& reading, Output& output) override;
  void finish(Output& output) override;
  void startAnew(Output& output) override;
  void setState(const Start& start, Output& output) override;
  void configure(const Config& config) override;
  double lag() const override { return options_->lag; }
  std::unique_ptr<InOrder> clone() const override;
  /// Between two stamps of the IMU integrated with the means of that interval, after the newest with the last ones, for
  /// a second.
  std::optional<NavigationSolution> predictedTo(Stamp stamp, const Reading* next) override;
  std::uint64_t corrections() const override { return estimator_ ? estimator_->corrections() : 0; }
  std::string failure() const override { return estimator_ ? estimator_->failure() : ""; }

  const Alignment& alignment() const { return alignment_; }
  /// How many readings of sensors that aid the estimator was given.
  std::uint64_t measurements() const { return measurements_; }
  const InertialCounts& inertial() const { return inertial_; }

 private:
  void take(const Event& event, Output& output);
  void begin(const Start& start, Output& output);
  void count(const ImuReading& reading, ImuVerdict verdict);

  std::shared_ptr<const SessionOptions> options_;  // shared with copies
  std::string name_;
  EstimatorFactory make_;
  Alignment alignment_;
  std::vector<Event> events_;
  std::unique_ptr<Estimator> estimator_;  // null before the start
  std::optional<ImuReading> last_;
  InertialCounts inertial_;
  std::optional<Stamp> last_integrated_;
  std::uint64_t intervals_ = 0, measurements_ = 0;
};

}  // namespace sas_motion::ins
