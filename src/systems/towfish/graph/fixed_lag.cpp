// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/fixed_lag.hpp"

#include <gtsam_unstable/nonlinear/IncrementalFixedLagSmoother.h>

#include <algorithm>
#include <exception>

#include "sas_motion/systems/towfish/filter_estimator.hpp"
#include "sas_motion/systems/towfish/smoother_recorder.hpp"
#include "systems/towfish/graph/factors.hpp"

namespace sas_motion::towfish {
namespace {

constexpr double kMargin =
    1;  // GTSAM's window is this much longer, so that a node is put out before it is marginalised [s]

gtsam::ISAM2Params isamParameters() {
  gtsam::ISAM2Params params;
  params.relinearizeThreshold = 1e-3;  // weights are only taken anew where a factor is linearised anew
  params.relinearizeSkip = 1;
  params.findUnusedFactorSlots = true;
  return params;
}

}  // namespace

/// The sliding window: everything that a rebuild makes anew.
struct FixedLagSmoother::Window {
  struct Node {
    Key key;
    Stamp stamp;
    Loss loss;  // on its measurements
    std::vector<Measurement> measurements = {};
    bool put_out = false;  // a pause puts out the newest node too, which stays
  };

  explicit Window(const Config& settings)
      : config(settings),
        model(settings.model),
        filter(settings.filters.robust_kf),
        smoother(settings.fixed_lag.lag + settings.fixed_lag.solve_interval + kMargin, isamParameters()) {}

  void start(const Gaussian<kStates>& prior, Stamp stamp) {
    belief = prior;
    origin = stamp;
    addNode(stamp);
    factors.emplace_shared<PriorStateFactor>(nodes.back().key, prior);
  }

  bool started() const { return !nodes.empty(); }

  void addNode(Stamp stamp) {
    const Key key = next_key++;
    nodes.push_back({key, stamp, config.fixed_lag.loss});
    values.insert(key, belief.mean);
    timestamps[key] = secondsBetween(origin, stamp);
  }

  /// Adds a measurement that is not older than the newest node.
  void add(const Measurement& z) {
    if (z.stamp > nodes.back().stamp) {
      const double dt = secondsBetween(nodes.back().stamp, z.stamp);
      const Input known = input.at(z.stamp, config.input_hold);
      const auto transition = model.transition(belief.mean, known, dt);
      belief = filter.predict(belief, transition);
      const Key from = nodes.back().key;
      addNode(z.stamp);
      factors.emplace_shared<MotionFactor>(from, nodes.back().key, model, known, dt, transition.Q);
    }
    if (z.sensor == Sensor::TurnRate) {
      input.take(z);
      return;
    }
    addRows(factors, nodes.back().key, model, z, nodes.back().loss);
    nodes.back().measurements.push_back(z);
    model.linearize(z, belief.mean, [&](const auto& linear) { belief = filter.update(belief, linear).belief; });
    if (values.exists(nodes.back().key)) values.update(nodes.back().key, belief.mean);
  }

  /// Hands what is new to GTSAM. Throws what GTSAM throws.
  void solve() {
    smoother.update(factors, values, timestamps);
    factors.resize(0);
    values.clear();
    timestamps.clear();
    smoother.update();
    solved = nodes.back().stamp;
    const auto newest = smoother.calculateEstimate<StateVector>(nodes.back().key);
    belief.mean = newest;
  }

  Estimate estimate(const Node& node) const {
    return {node.stamp, {smoother.calculateEstimate<StateVector>(node.key), smoother.marginalCovariance(node.key)}};
  }

  Config config;
  Model model;
  RobustKalmanFilter<kStates> filter;  // for the starting value of each node, and the answer between solutions
  gtsam::IncrementalFixedLagSmoother smoother;
  gtsam::NonlinearFactorGraph factors;  // not yet solved
  gtsam::Values values;
  gtsam::FixedLagSmoother::KeyTimestampMap timestamps;
  std::deque<Node> nodes;  // not yet put out, newest last
  Gaussian<kStates> belief;
  HeldInput input;
  Stamp origin = 0;
  Stamp solved = 0;
  Key next_key = 0;
};

FixedLagSmoother::FixedLagSmoother(const Config& config)
    : config_(config), start_(config), window_(std::make_unique<Window>(config)) {}
FixedLagSmoother::~FixedLagSmoother() = default;

void FixedLagSmoother::process(const Measurement& z, Output& output) {
  if (!window_->started()) return start_.add(z);
  const Stamp newest = window_->nodes.back().stamp;
  const bool due = z.stamp > newest && newest - window_->solved >= stampFromSeconds(config_.fixed_lag.solve_interval);
  if (due) solve(output);  // the newest node is complete
  window_->add(z);
}

void FixedLagSmoother::endStamp(Output& output) {
  if (window_->started()) return;
  const auto prior = start_.find(output);
  if (!prior) return;
  window_->start(*prior, start_.gathered().front().stamp);
  for (const auto& z : start_.gathered()) process(z, output);
  start_.clear();
}

void FixedLagSmoother::solve(Output& output) {
  ++corrections_;
  try {
    window_->solve();
    settle(window_->nodes.back().stamp - stampFromSeconds(config_.fixed_lag.lag), output);
  } catch (const std::exception&) {
    rebuild(output);
  }
}

/// Starts a new window from the companion filter's belief; the nodes of the old one are put out with what is known of
/// them: nothing.
void FixedLagSmoother::rebuild(Output& output) {
  ++rebuilds_;
  for (const auto& node : window_->nodes)
    for (const auto& z : node.measurements)
      output.audits.push_back(refusal(z, Verdict::Invalid, "the solver failed and was rebuilt"));
  auto fresh = std::make_unique<Window>(config_);
  fresh->input = window_->input;
  fresh->start(window_->belief, window_->nodes.back().stamp);
  fresh->nodes.back().put_out = window_->nodes.back().put_out;
  window_ = std::move(fresh);
}

void FixedLagSmoother::settle(Stamp until, Output& output) {
  auto& nodes = window_->nodes;
  until = std::min(until, window_->solved);
  while (!nodes.empty() && nodes.front().stamp <= until) {
    auto& node = nodes.front();
    if (!node.put_out) {
      const Estimate estimate = window_->estimate(node);
      for (const auto& z : node.measurements) {
        const auto weights = weightsAt(z, estimate.belief.mean, window_->model, node.loss);
        output.audits.push_back(smoothedAudit(z, estimate.belief.mean, window_->model, weights, 1));
      }
      output.solutions.push_back(estimate);
      node.measurements.clear();
      node.put_out = true;
    }
    if (nodes.size() == 1) return;  // the newest node stays: the next motion factor starts there
    nodes.pop_front();
  }
}

void FixedLagSmoother::finish(Output& output) {
  start_.refuseAll(output);
  if (!window_->started()) return;
  solve(output);
  settle(window_->nodes.back().stamp, output);
}

void FixedLagSmoother::startAnew(Output& output) {
  finish(output);
  start_.shorten();
  window_ = std::make_unique<Window>(config_);
}

void FixedLagSmoother::setState(const Estimate& state, Output& output) {
  finish(output);
  auto fresh = std::make_unique<Window>(config_);
  fresh->input = window_->input;
  fresh->start(state.belief, state.stamp);
  fresh->nodes.back().put_out = true;  // the answer there is settled, or the caller's own
  window_ = std::move(fresh);
}

std::unique_ptr<Estimator> FixedLagSmoother::clone() const {
  if (!window_->started()) return nullptr;
  const auto make = [](const Config& config) {
    return guarded(RobustKalmanFilter<kStates>(config.filters.robust_kf), config.filters.reset_after);
  };
  const Estimate newest{window_->nodes.back().stamp, window_->belief};
  return std::make_unique<FilterEstimator<Guarded<RobustKalmanFilter<kStates>>>>(make, config_, newest, window_->input);
}

void FixedLagSmoother::configure(const Config& config) {
  config_ = config;
  window_->config = config;
  window_->filter = RobustKalmanFilter<kStates>(config.filters.robust_kf);
}

}  // namespace sas_motion::towfish
