// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/session.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::towfish {
namespace {

const LocalFrame* mapOf(const OutputFrame& frame) { return frame.map ? &*frame.map : nullptr; }

std::optional<Solution> inFrame(const std::optional<Estimate>& estimate, const OutputFrame& frame) {
  return estimate ? std::optional(solutionOf(*estimate, mapOf(frame))) : std::nullopt;
}

}  // namespace

TowfishSession::TowfishSession(const Config& config, const std::vector<std::string>& names,
                               const EstimatorFactory& make)
    : Session(names), config_(config) {
  for (const auto& name : names) {
    lanes_.push_back({make(name, config), {}, {}});
    if (!lanes_.back().estimator) throw std::invalid_argument(fmt::format("'{}' is no estimator of this system", name));
  }
}

void TowfishSession::feed() {
  for (auto& lane : lanes_) {
    const double begin = cpuSeconds();
    for (const auto& z : unfed_) lane.estimator->process(z, lane.output);
    lane.report.seconds += cpuSeconds() - begin;
    lane.report.measurements += unfed_.size();
  }
  unfed_.clear();
}

void TowfishSession::finish() {
  feed();
  for (auto& lane : lanes_) {
    const double begin = cpuSeconds();
    lane.estimator->finish(lane.output);
    lane.report.seconds += cpuSeconds() - begin;
    lane.report.failure = lane.estimator->failure();
  }
}

void TowfishSession::reset() {
  unfed_.clear();
  for (auto& lane : lanes_) {
    lane.estimator->reset();
    lane.output.clear();
    lane.report = {};
  }
}

void TowfishSession::takeSettled(std::size_t lane, const OutputFrame& frame, sas_motion::Output& output) {
  auto& settled = lanes_[lane].output;
  for (const auto& estimate : settled.solutions) output.solutions.push_back(solutionOf(estimate, mapOf(frame)));
  output.audits.insert(output.audits.end(), settled.audits.begin(), settled.audits.end());
  settled.clear();
}

std::optional<Solution> TowfishSession::current(std::size_t lane, const OutputFrame& frame) const {
  return inFrame(lanes_[lane].estimator->current(), frame);
}

std::optional<Solution> TowfishSession::at(std::size_t lane, const OutputFrame& frame, Stamp stamp) const {
  return inFrame(lanes_[lane].estimator->at(stamp), frame);
}

std::string TowfishSession::setState(std::size_t index, const OutputFrame&, const StateRequest& request) {
  Lane& lane = lanes_[index];
  Estimate state{request.stamp, beliefOf(request)};
  if (state.stamp == 0) {
    const auto newest = lane.estimator->current();
    if (!newest) return "there is no estimate yet, so give a stamp";
    state.stamp = newest->stamp;
  }
  const char* reason = lane.estimator->setState(state, lane.output);
  return reason ? reason : "";
}

void TowfishSession::configure(const Tuning& tuning) {
  tune(config_, tuning);
  for (auto& lane : lanes_) lane.estimator->configure(config_);
}

LaneReport TowfishSession::report(std::size_t lane) const { return lanes_[lane].report; }

}  // namespace sas_motion::towfish
