// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/alignment.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/ins_gps_dvl/reading_queue.hpp"

namespace sas_motion::ins {

/// What decides estimates beside the readings.
struct SessionOptions {
  Config config;  ///< its start's standard deviations and lever arms are those of the alignment, where that knows them
  AlignmentOptions alignment;
  double lag = 5;       ///< late readings are fused at their own time up to this age [s]
  double max_gap = 10;  ///< after a longer gap of the inertial unit estimators start anew [s]
};

/// One estimator on its way.
struct Lane {
  std::string name;
  std::unique_ptr<Estimator> estimator;  ///< null before the start
  Output output;                         ///< the caller clears it
  std::uint64_t starts = 0;              ///< how often it has begun
  std::uint64_t readings = 0;            ///< that it was fed with
  double seconds = 0;                    ///< CPU time of the estimator alone
};

/// What became of the readings of the inertial unit.
struct InertialCounts {
  std::array<std::uint64_t, kImuVerdicts> verdicts{};  ///< by ImuVerdict
  std::uint64_t late = 0, duplicate = 0,
                far = 0;  ///< left out before: older than the lag, same stamp, a stamp far from the others
  double longest_gap = 0, mean_period = 0;  ///< of the readings that were integrated [s]
};

/// A run of estimators over readings that come in any order inside the lag, live or from a bag alike: puts them in time
/// order, finds the start, and starts anew where the clock was set. What it says is settled: it depends on the readings
/// alone and not on their order.
class EstimatorRun {
 public:
  /// Throws std::invalid_argument where the factory knows no such estimator.
  EstimatorRun(const SessionOptions& options, const std::vector<std::string>& names, EstimatorFactory factory);

  /// Takes a reading of any age, and returns what became of it. Data never throws.
  ReadingQueue::Answer process(const Reading& reading);
  /// Runs the estimators over what has settled since.
  void feed();
  /// The end of the data, or a pause: settles everything that is still open.
  void finish();

  /// Starts one lane anew with a state that a user sets: what was read after its stamp is fused again. The stamp is not
  /// before what has settled.
  void startAt(std::size_t lane, const Start& start);
  /// Other tunings, for readings that have not settled yet.
  void configure(const Config& config);
  const Config& config() const { return options_.config; }

  std::vector<Lane>& lanes() { return lanes_; }
  const std::vector<Lane>& lanes() const { return lanes_; }
  const Alignment& alignment() const { return alignment_; }
  const InertialCounts& inertial() const { return inertial_; }
  const ReadingQueue& queue() const { return queue_; }
  std::size_t unfed() const { return events_.size(); }

 private:
  void refuse(const Reading& reading, ReadingQueue::Answer answer);
  void settleAll();
  void startAnew();
  void feed(Lane& lane, const Event& event);
  void count(const ImuReading& reading, ImuVerdict verdict);

  SessionOptions options_;
  EstimatorFactory factory_;
  ReadingQueue queue_;
  Alignment alignment_;
  std::vector<Event> events_;
  std::vector<Lane> lanes_;
  InertialCounts inertial_;
  std::optional<Stamp> last_integrated_;
  std::uint64_t intervals_ = 0;
};

}  // namespace sas_motion::ins
