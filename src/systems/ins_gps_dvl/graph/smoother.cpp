// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/smoother.hpp"

#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"

namespace sas_motion::ins {
namespace {

constexpr int kLiveIterations = 5;
constexpr double kLiveTolerance = 1e-5;  // [-]

/// A filter that goes on from a solution: at the stamp of that its estimate had an error, which grows by the
/// velocity's.
class Present final : public Estimator {
 public:
  Present(const RobustKf27& filter, const Vector<kNodeStates>& error, Stamp stamp)
      : filter_(filter), error_(error), stamp_(stamp) {}

  void start(const NavigationState&, Stamp) override {}
  void process(const Aiding& reading, Output&) override { filter_.add(reading); }
  ImuVerdict process(const ImuReading& reading, Output& output) override {
    const ImuVerdict verdict = filter_.add(reading).verdict;
    auto solution = *solutionOf(filter_, Source::Fused);
    Vector<kNodeStates> error = error_;
    error.segment<3>(kPosition) += secondsBetween(stamp_, solution.stamp) * error_.segment<3>(kVelocity);
    solution.state = nodeOf(solution.state, filter_.belief().mean).retract(-error).state;
    output.solutions.push_back(solution);
    return verdict;
  }
  std::unique_ptr<Estimator> clone() const override { return std::make_unique<Present>(*this); }

 private:
  RobustKf27 filter_;
  Vector<kNodeStates> error_;
  Stamp stamp_;
};

}  // namespace

std::unique_ptr<Estimator> InsSmoother::clone() const {
  if (!chain_ || !options_.window) return nullptr;
  return std::make_unique<Present>(chain_->filter(), filter_error_, solved_);
}

void InsSmoother::start(const NavigationState& state, Stamp stamp) {
  chain_.emplace(config_, state, stamp);
  window_.emplace(chain_->filter().model(), options_.loss, state, chain_->filter().belief(), stamp);
  stops_.clear();
  solved_ = stamp;
  last_start_ = window_->node(0);
  filter_error_.setZero();
  failure_ = "";
}

void InsSmoother::process(const Aiding& reading, Output&) {
  if (chain_) chain_->add(reading);
}

ImuVerdict InsSmoother::process(const ImuReading& reading, Output& output) {
  if (!chain_) return ImuVerdict::OutOfOrder;
  const ImuVerdict verdict = chain_->add(reading, output.audits, stops_);
  take(output);
  return verdict;
}

/// Moves what is complete into the window.
void InsSmoother::addStops() {
  for (const auto& stop : stops_) {
    window_->add(stop);
    last_start_ = stop.start;
  }
  stops_.clear();
}

/// Takes what is complete, and solves the window where that is due.
void InsSmoother::take(Output& output) {
  addStops();
  const Stamp newest = window_->stamp(window_->size() - 1);
  if (!options_.window || secondsBetween(solved_, newest) < options_.window->solve_interval) return;
  solve(kLiveIterations, kLiveTolerance, output);
  std::size_t settled = 0;
  while (settled + 1 < window_->size() && secondsBetween(window_->stamp(settled), newest) > options_.window->lag)
    ++settled;
  settle(settled, output);
}

void InsSmoother::finish(Output& output) {
  if (!chain_) return;
  chain_->close(stops_);
  addStops();
  failure_ = "";
  solve(options_.max_iterations, options_.tolerance, output);
  if (!failure_.empty()) return;
  const std::size_t last = window_->size() - 1;
  settle(last, output);
  const auto audits = window_->audits(0);
  output.audits.insert(output.audits.end(), audits.begin(), audits.end());
  window_->closeLast();
}

void InsSmoother::solve(int max_iterations, double tolerance, Output& output) {
  ++corrections_;
  const std::string failure = window_->solve(max_iterations, tolerance);
  solved_ = window_->stamp(window_->size() - 1);
  if (failure.empty()) {
    filter_error_ = window_->node(window_->size() - 1).localCoordinates(last_start_);
    return;
  }
  failure_ = failure;
  filter_error_.setZero();
  beginAnew(output);
}

/// After a failure: from the belief of the filter beside; the window's nodes are lost.
void InsSmoother::beginAnew(Output& output) {
  for (std::size_t k = 0; k < window_->size(); ++k)
    for (auto audit : window_->audits(k)) {
      audit.verdict = Verdict::Invalid;
      output.audits.push_back(audit);
    }
  chain_->close(stops_);
  stops_.clear();
  const RobustKf27& filter = chain_->filter();
  window_.emplace(filter.model(), options_.loss, filter.fused(), filter.belief(), filter.stamp());
  last_start_ = window_->node(0);
}

void InsSmoother::settle(std::size_t count, Output& output) {
  for (std::size_t k = 0; k < count; ++k) putOut(k, output);
  window_->forget(count);
}

/// A node's readings, and the way to the next one at the stamps of the IMU.
void InsSmoother::putOut(std::size_t node, Output& output) const {
  const auto audits = window_->audits(node);
  output.audits.insert(output.audits.end(), audits.begin(), audits.end());
  const InertialInterval& way = window_->wayFrom(node);
  const Node from = window_->node(node), to = window_->node(node + 1);
  Node end = to;
  end.state = integrate(way, from, window_->constants()).end;
  const Vector<kNodeStates> missed = to.localCoordinates(end);
  integrate(way, from, window_->constants(), [&](const Mechanisation& ins, const InertialInterval::Piece& piece) {
    if (piece.end != piece.reading.stamp) return;
    const double share = secondsBetween(window_->stamp(node), piece.end) / way.duration;
    Node on_way = to;
    on_way.state = ins.state();
    output.solutions.push_back(
        {piece.end, on_way.retract(-share * missed).state, true, true,
         Matrix<9>((1 - share) * window_->covariance(node) + share * window_->covariance(node + 1))});
  });
}

std::unique_ptr<Estimator> makeAnyEstimator(const std::string& name, const Config& config) {
  InsSmoother::Options options{config.batch.loss, std::nullopt, config.batch.max_iterations, config.batch.tolerance};
  if (name == "batch") return std::make_unique<InsSmoother>(config, options);
  if (name != "fixed_lag") return makeEstimator(name, config);
  options.loss = config.fixed_lag.loss;
  options.window = config.fixed_lag;
  return std::make_unique<InsSmoother>(config, options);
}

const std::vector<std::string>& anyEstimatorNames() {
  static const std::vector<std::string> names = [] {
    auto all = estimatorNames();
    all.insert(all.end(), {"batch", "fixed_lag"});
    return all;
  }();
  return names;
}

}  // namespace sas_motion::ins
