// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/session/session.hpp"
#include "sas_motion/session/timeline.hpp"

namespace sas_motion {

/// A session of the estimators of one kind of system; the system converts its states to solutions.
template <class Estimator>
class SessionOf : public Session {
 public:
  using Reading = typename Estimator::Reading;
  using State = typename Estimator::State;
  using Config = typename Estimator::Config;
  using Factory = std::function<std::unique_ptr<Estimator>(const std::string& name)>;

  /// `live`: keep the present answers. Throws std::invalid_argument where the factory makes no such estimator.
  SessionOf(const Config& config, double max_gap, const std::vector<std::string>& names, Factory make, bool live)
      : Session(names), config_(config), max_gap_(max_gap), make_(std::move(make)), live_(live) {
    reset();
  }

  void process(const Reading& reading) { unfed_.push_back(reading); }

  void feed() override {
    for (auto& lane : lanes_) {
      const double begin = cpuSeconds();
      for (const auto& reading : unfed_) lane.timeline.process(reading, lane.output);
      lane.report.seconds += cpuSeconds() - begin;
      lane.report.measurements += unfed_.size();
    }
    unfed_.clear();
  }
  std::size_t unfed() const override { return unfed_.size(); }
  void finish() override {
    feed();
    for (auto& lane : lanes_) {
      const double begin = cpuSeconds();
      lane.timeline.finish(lane.output);
      lane.report.seconds += cpuSeconds() - begin;
      lane.report.failure = lane.timeline.settled().failure();
    }
  }
  void reset() override {
    unfed_.clear();
    lanes_.clear();
    for (const auto& name : names()) {
      auto estimator = make_(name);
      if (!estimator) throw std::invalid_argument(fmt::format("'{}' is no estimator of this system", name));
      lanes_.push_back({Timeline<Estimator>(std::move(estimator), config_, max_gap_, live_), {}, {}});
    }
  }

  void takeSettled(std::size_t lane, const OutputFrame& frame, Output& output) override {
    auto& settled = lanes_[lane].output;
    for (const auto& state : settled.solutions)
      if (const auto solution = settledSolution(lane, state, frame)) output.solutions.push_back(*solution);
    output.audits.insert(output.audits.end(), settled.audits.begin(), settled.audits.end());
    settled.clear();
  }
  std::optional<Solution> current(std::size_t lane, const OutputFrame& frame) const override {
    return inFrame(lanes_[lane].timeline.current(), frame);
  }
  std::optional<Solution> at(std::size_t lane, const OutputFrame& frame, Stamp stamp) const override {
    return inFrame(lanes_[lane].timeline.at(stamp), frame);
  }
  void configure(const Tuning& tuning) override {
    tune(config_, tuning);
    for (auto& lane : lanes_) lane.timeline.configure(config_);
  }
  LaneReport report(std::size_t lane) const override { return lanes_[lane].report; }

 protected:
  /// A state where the frame is known; else nothing.
  virtual std::optional<Solution> solution(const State& state, const OutputFrame& frame) const = 0;
  /// A settled state as a solution; nothing where the system answers at a lower rate than its estimators.
  virtual std::optional<Solution> settledSolution(std::size_t, const State& state, const OutputFrame& frame) {
    return solution(state, frame);
  }
  const Timeline<Estimator>& timeline(std::size_t lane) const { return lanes_[lane].timeline; }
  std::string setStart(std::size_t index, const typename Estimator::Start& start) {
    const char* reason = lanes_[index].timeline.setState(start, lanes_[index].output);
    return reason ? reason : "";
  }
  const Config& config() const { return config_; }

 private:
  struct Lane {
    Timeline<Estimator> timeline;
    typename Estimator::Output output;
    LaneReport report;
  };

  std::optional<Solution> inFrame(const std::optional<State>& state, const OutputFrame& frame) const {
    return state ? solution(*state, frame) : std::nullopt;
  }

  Config config_;
  double max_gap_;  // [s]
  Factory make_;
  bool live_;
  std::vector<Lane> lanes_;
  std::vector<Reading> unfed_;
};

}  // namespace sas_motion
