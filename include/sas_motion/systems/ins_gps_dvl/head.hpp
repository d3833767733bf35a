// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "sas_motion/systems/ins_gps_dvl/run.hpp"

namespace sas_motion::ins {

/// The present of an estimator: a copy of the settled one, carried on through the readings whose order can still
/// change. Where one comes late, it goes back to a checkpoint before it and takes the readings after that again, so
/// that any order of arrival gives the same present. An estimator that cannot be copied has none.
class Head {
 public:
  using Readings = std::deque<Reading>;

  /// Begins anew: `settled` has taken everything but the open readings.
  void restart(const Estimator& settled, const Readings& open);
  void forget();
  /// The first open readings have settled, and are no longer among them.
  void settle(std::size_t count);
  /// One more is open, at this place.
  void insert(const Estimator& settled, const Readings& open, std::size_t place);

  /// The newest solution.
  const std::optional<NavigationSolution>& current() const { return current_; }
  /// The solution at any stamp from the last settled one on: between two stamps of the inertial unit integrated with
  /// the means of that interval, after the newest with the last ones, up to `furthest` [s].
  std::optional<NavigationSolution> at(const Estimator& settled, const Readings& open, Stamp stamp,
                                       double furthest) const;

 private:
  struct Checkpoint {
    std::size_t next;  // the first open reading that it has not taken
    std::unique_ptr<Estimator> estimator;
  };

  void replay(const Estimator& settled, const Readings& open, std::size_t place);
  void take(const Readings& open, std::size_t place);

  std::deque<Checkpoint> checkpoints_;  // in order
  std::unique_ptr<Estimator> estimator_;
  std::optional<NavigationSolution> current_;
  std::optional<Stamp> last_checkpoint_;
  Output output_;
};

/// A run with the present of each of its estimators.
class LiveRun {
 public:
  /// `keeps_present`: else it is the run alone, which is then fed by its owner.
  LiveRun(const SessionOptions& options, const std::vector<std::string>& names, EstimatorFactory factory,
          bool keeps_present = true)
      : run_(options, names, std::move(factory)),
        heads_(names.size()),
        starts_(names.size()),
        keeps_present_(keeps_present) {}

  /// Takes a reading of any age. What it settles is in the lanes' output.
  ReadingQueue::Answer process(const Reading& reading);
  /// The end of the data, or a pause: settles everything that is still open.
  void finish();

  /// As EstimatorRun::startAt() and EstimatorRun::configure().
  void startAt(std::size_t lane, const Start& start);
  void configure(const Config& config);

  EstimatorRun& run() { return run_; }
  const EstimatorRun& run() const { return run_; }
  /// Of the lane with this number; nothing before the start.
  const std::optional<NavigationSolution>& current(std::size_t lane) const { return heads_[lane].current(); }
  std::optional<NavigationSolution> at(std::size_t lane, Stamp stamp) const;

 private:
  void update(std::size_t lane, bool taken, std::size_t settled);

  EstimatorRun run_;
  std::vector<Head> heads_;
  std::vector<std::uint64_t> starts_;  // of the lanes, that the heads know of
  bool keeps_present_;
};

}  // namespace sas_motion::ins
