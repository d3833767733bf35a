// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "systems/ins_gps_dvl/graph/window.hpp"

namespace sas_motion::ins {

/// The fusion as a factor graph. A node is settled and put out when it is older than the lag, or at the end; `batch`
/// waits for that. Between two nodes the answer is integrated from the first, and what it misses the second by is
/// spread over the time between them, so that it nowhere jumps.
class InsSmoother final : public Estimator {
 public:
  struct Options {
    Loss loss{LossKind::Huber};
    std::optional<FixedLag> window;  ///< none: everything at once, at the end
    int max_iterations = 100;        ///< at the end
    double tolerance = 1e-9;         ///< the same, see SmootherOptions [-]
  };

  InsSmoother(const Config& config, const Options& options) : config_(config), options_(options) {}

  void start(const NavigationState& state, Stamp stamp) override;
  void process(const Aiding& reading, Output& output) override;
  ImuVerdict process(const ImuReading& reading, Output& output) override;
  void finish(Output& output) override;
  std::uint64_t corrections() const override { return corrections_; }
  std::string failure() const override { return failure_; }
  /// Of a sliding window: the present, by the filter beside it from where the last solution puts the last node.
  std::unique_ptr<Estimator> clone() const override;

  /// The nodes that are not forgotten; null before the start.
  const InsWindow* window() const { return window_ ? &*window_ : nullptr; }

 private:
  void addStops();
  void take(Output& output);
  void solve(int max_iterations, double tolerance, Output& output);
  void beginAnew(Output& output);
  void settle(std::size_t count, Output& output);
  void putOut(std::size_t node, Output& output) const;

  Config config_;
  Options options_;
  std::optional<InsChain> chain_;
  std::optional<InsWindow> window_;
  std::vector<InsChain::Stop> stops_;  // not yet in the window
  Stamp solved_ = 0;
  std::uint64_t corrections_ = 0;
  Node last_start_;                                                 // the filter's estimate at the last node
  Vector<kNodeStates> filter_error_ = Vector<kNodeStates>::Zero();  // by the last solution, at solved_
  std::string failure_;
};

/// All estimators: those of makeEstimator and batch, fixed_lag. Null for an unknown name.
std::unique_ptr<Estimator> makeAnyEstimator(const std::string& name, const Config& config);

/// The names that makeAnyEstimator accepts.
const std::vector<std::string>& anyEstimatorNames();

}  // namespace sas_motion::ins
