// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/fixed_lag.hpp"

#include <gtsam_unstable/nonlinear/IncrementalFixedLagSmoother.h>

#include <algorithm>
#include <exception>

#include "sas_motion/systems/towfish/held_input.hpp"
#include "sas_motion/systems/towfish/smoother_recorder.hpp"
#include "sas_motion/systems/towfish/start.hpp"
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
    : config_(config),
      clock_(config.max_gap, config.fixed_lag.reorder),
      start_window_(config.start.window),
      window_(std::make_unique<Window>(config)) {}
FixedLagSmoother::~FixedLagSmoother() = default;

void FixedLagSmoother::process(const Measurement& z, Output& output) {
  if (const char* reason = invalidity(z, config_)) {
    output.audits.push_back(refusal(z, Verdict::Invalid, reason));
    return;
  }
  const auto answer = clock_.judge(z, output);
  if (answer == ClockGuard::Answer::ClockSet) startAnew(output);
  if (answer == ClockGuard::Answer::Believed) insert(z, output);
}

void FixedLagSmoother::startAnew(Output& output) {
  const auto agreed = clock_.release();
  settleAll(output);
  for (const auto& z : waiting_)
    output.audits.push_back(refusal(z, Verdict::Stale, "before the first position and heading"));
  forget();
  start_window_ = config_.start.window * ClockGuard::kShortenedStart;
  for (const auto& z : agreed) insert(z, output);
}

void FixedLagSmoother::insert(const Measurement& z, Output& output) {
  if (released_ && z.stamp <= *released_) {
    output.audits.push_back(refusal(z, Verdict::Stale, "older than the smoother's reorder time"));
    return;
  }
  const auto place = std::lower_bound(waiting_.begin(), waiting_.end(), z, before);
  if (place != waiting_.end() && !before(z, *place)) {
    output.audits.push_back(refusal(z, Verdict::Invalid, "duplicate stamp"));
    return;
  }
  waiting_.insert(place, z);
  const double wait = config_.fixed_lag.reorder + (window_->started() ? 0 : start_window_);
  release(waiting_.back().stamp - stampFromSeconds(wait), output);
}

void FixedLagSmoother::release(Stamp until, Output& output) {
  if (!window_->started() && !start(until, output)) return;
  while (!waiting_.empty() && waiting_.front().stamp <= until) {
    const Measurement z = waiting_.front();
    waiting_.pop_front();
    const bool due = z.stamp > window_->nodes.back().stamp && window_->nodes.back().stamp - window_->solved >=
                                                                  stampFromSeconds(config_.fixed_lag.solve_interval);
    if (due) solve(output);  // the newest node is complete
    released_ = z.stamp;
    window_->add(z);
  }
}

bool FixedLagSmoother::start(Stamp until, Output& output) {
  while (!waiting_.empty() && waiting_.front().stamp <= until) {
    const Stamp first = waiting_.front().stamp;
    std::vector<Measurement> window;
    for (const auto& z : waiting_)
      if (z.stamp <= first + stampFromSeconds(start_window_)) window.push_back(z);
    if (const auto prior = startingBelief(first, window, config_.start, config_.model.current_sigma)) {
      window_->start(*prior, first);
      return true;
    }
    output.audits.push_back(refusal(waiting_.front(), Verdict::Stale, "before the first position and heading"));
    released_ = first;
    waiting_.pop_front();
  }
  return false;
}

void FixedLagSmoother::solve(Output& output) {
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

void FixedLagSmoother::settleAll(Output& output) {
  if (!waiting_.empty()) release(waiting_.back().stamp, output);
  if (!window_->started()) return;
  solve(output);
  settle(window_->nodes.back().stamp, output);
}

void FixedLagSmoother::finish(Output& output) {
  clock_.refuseHeld(output);
  settleAll(output);
}

std::optional<Estimate> FixedLagSmoother::current() const {
  if (!window_->started() || window_->solved == 0) return std::nullopt;
  return Estimate{window_->nodes.back().stamp, window_->belief};
}

std::optional<Estimate> FixedLagSmoother::at(Stamp) const { return std::nullopt; }

const char* FixedLagSmoother::setState(const Estimate& state, Output& output) {
  if (released_ && state.stamp < *released_) return "the stamp is older than the smoother's reorder time";
  if (!clock_.believable(state.stamp)) return "the stamp is far from those of the measurements";
  clock_.believe(state.stamp);
  release(state.stamp, output);
  if (window_->started()) {
    solve(output);
    settle(window_->nodes.back().stamp, output);
  }
  for (; !waiting_.empty() && waiting_.front().stamp <= state.stamp; waiting_.pop_front())
    output.audits.push_back(refusal(waiting_.front(), Verdict::Stale, "before the state that was set"));
  auto fresh = std::make_unique<Window>(config_);
  fresh->input = window_->input;
  fresh->start(state.belief, state.stamp);
  fresh->nodes.back().put_out = true;  // the answer there is settled, or the caller's own
  window_ = std::move(fresh);
  released_ = state.stamp;
  return nullptr;
}

void FixedLagSmoother::configure(const Config& config) {
  config_ = config;
  window_->config = config;
  window_->filter = RobustKalmanFilter<kStates>(config.filters.robust_kf);
}

void FixedLagSmoother::reset() {
  forget();
  clock_.reset();
  start_window_ = config_.start.window;
}

void FixedLagSmoother::forget() {
  window_ = std::make_unique<Window>(config_);
  waiting_.clear();
  released_.reset();
}

}  // namespace sas_motion::towfish
