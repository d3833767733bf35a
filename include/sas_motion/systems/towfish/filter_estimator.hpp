// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "sas_motion/systems/towfish/held_input.hpp"
#include "sas_motion/systems/towfish/start_finder.hpp"

namespace sas_motion::towfish {

/// The motion from one stamp to a later one about a mean: the model's, or one with more information.
using Motion = std::function<Transition<kStates>(const StateVector& mean, const Input& input, Stamp from, Stamp to)>;

/// A filter of the towfish's state.
template <class Filter>
class FilterEstimator final : public Estimator {
 public:
  using Make = std::function<Filter(const Config&)>;

  FilterEstimator(Make make, const Config& config);
  /// Predicts by `motion` instead of the model's own motion.
  FilterEstimator(Make make, const Config& config, Motion motion);
  /// One that goes on from an estimate.
  FilterEstimator(Make make, const Config& config, const Estimate& estimate, const HeldInput& input);

  void process(const Measurement& z, Output& output) override;
  void endStamp(Output& output) override;
  void finish(Output& output) override;
  void startAnew(Output& output) override;
  void setState(const Estimate& state, Output& output) override;
  void configure(const Config& config) override;
  double lag() const override { return setup_->config.lag; }
  std::unique_ptr<Estimator> clone() const override { return std::make_unique<FilterEstimator>(*this); }
  std::optional<Estimate> predictedTo(Stamp stamp, const Measurement* next) override;

 private:
  struct Setup {
    Make make;
    Config config;
    Model model;
    Motion motion;
    Filter filter;
  };
  struct Moment {
    Stamp stamp;
    typename Filter::Belief belief;
  };

  void advance(Stamp stamp);
  void fuse(const Measurement& z, Output& output);
  void putOut(Output& output) const;

  std::shared_ptr<const Setup> setup_;  // shared with copies
  StartFinder start_;
  std::optional<Moment> now_;  // after the last measurement; nothing before the start
  HeldInput input_;
};

}  // namespace sas_motion::towfish
