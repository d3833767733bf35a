// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>

#include "sas_motion/systems/towfish/estimator.hpp"
#include "sas_motion/systems/towfish/problem.hpp"

namespace sas_motion::towfish {

/// A residual and its weights at a smoothed state. There is no innovation covariance: S and NIS stay zero.
Audit smoothedAudit(const Measurement& z, const StateVector& x, const Model& model, const Vector<2>& weights,
                    int iterations);

/// A batch smoother as an estimator: it records every measurement and solves when the data end. Should more come and
/// end, it solves all since the start anew and puts all of it out again.
class SmootherRecorder final : public Estimator {
 public:
  using Solve = std::function<SmootherResult(const SmoothingProblem&)>;

  SmootherRecorder(const Config& config, Solve solve) : config_(config), solve_(std::move(solve)) {}

  void process(const Measurement& z, Output& output) override;
  void finish(Output& output) override;
  void startAnew(Output&) override {}
  double lag() const override { return std::numeric_limits<double>::infinity(); }
  bool keepsPresent() const override { return false; }
  std::string failure() const override { return summary_.failure; }

  /// The last solution, without its states.
  const SmootherResult& summary() const { return summary_; }

 private:
  Config config_;
  Solve solve_;
  std::vector<Measurement> measurements_;  // in time order
  bool unsolved_ = true;                   // there may be more than at the last finish()
  SmootherResult summary_;
};

}  // namespace sas_motion::towfish
