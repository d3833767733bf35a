// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/run.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::ins {

EstimatorRun::EstimatorRun(const SessionOptions& options, const std::vector<std::string>& names,
                           EstimatorFactory factory)
    : options_(options),
      factory_(std::move(factory)),
      queue_(options.lag, options.max_gap),
      alignment_(options.alignment, options.config.parameters) {
  for (const auto& name : names) {
    if (!factory_(name, options.config))
      throw std::invalid_argument(fmt::format("'{}' is no estimator of this system", name));
    lanes_.push_back({name, nullptr, {}});
  }
}

ReadingQueue::Answer EstimatorRun::process(const Reading& reading) {
  const auto answer = queue_.insert(reading);
  if (answer == ReadingQueue::Answer::ClockSet)
    startAnew();
  else if (answer != ReadingQueue::Answer::Taken)
    refuse(reading, answer);
  while (queue_.settles()) alignment_.take(queue_.takeFirst(), events_);
  return answer;
}

void EstimatorRun::refuse(const Reading& reading, ReadingQueue::Answer answer) {
  using Answer = ReadingQueue::Answer;
  const auto* aiding = std::get_if<Aiding>(&reading);
  if (aiding && answer == Answer::Late) events_.push_back(refusal(*aiding, Verdict::Stale, "older than the lag"));
  if (aiding && answer == Answer::Duplicate) events_.push_back(refusal(*aiding, Verdict::Invalid, "duplicate stamp"));
  if (aiding && answer == Answer::Far)
    events_.push_back(refusal(*aiding, Verdict::Invalid, "stamp far ahead of the others"));
  if (!std::holds_alternative<InertialReading>(reading)) return;
  inertial_.late += answer == Answer::Late;
  inertial_.duplicate += answer == Answer::Duplicate;
  inertial_.far += answer == Answer::Far;
}

void EstimatorRun::settleAll() {
  while (!queue_.open().empty()) alignment_.take(queue_.takeFirst(), events_);
}

void EstimatorRun::startAnew() {
  settleAll();
  queue_.restart();
  alignment_ = Alignment(options_.alignment, options_.config.parameters);
}

void EstimatorRun::startAt(std::size_t lane, const Start& start) {
  while (!queue_.open().empty() && stampOf(queue_.open().front()) <= start.stamp)
    alignment_.take(queue_.takeFirst(), events_);
  feed();
  feed(lanes_[lane], start);
}

void EstimatorRun::configure(const Config& config) {
  options_.config = config;
  for (auto& lane : lanes_)
    if (lane.estimator) lane.estimator->configure(config);
}

void EstimatorRun::feed() {
  for (auto& lane : lanes_) {
    const double begin = cpuSeconds();
    for (const auto& event : events_) feed(lane, event);
    lane.seconds += cpuSeconds() - begin;
  }
  events_.clear();
}

void EstimatorRun::feed(Lane& lane, const Event& event) {
  if (const auto* audit = std::get_if<Audit>(&event)) {
    lane.output.audits.push_back(*audit);
  } else if (const auto* start = std::get_if<Start>(&event)) {
    if (lane.estimator) lane.estimator->finish(lane.output);
    Config config = options_.config;
    config.parameters = start->parameters;
    lane.estimator = factory_(lane.name, config);
    lane.estimator->start(start->state, start->stamp);
    ++lane.starts;
    if (&lane == &lanes_.front()) last_integrated_.reset();
  } else if (const auto* aiding = std::get_if<Aiding>(&event)) {
    lane.estimator->process(*aiding, lane.output);
    ++lane.readings;
  } else {
    const auto& reading = std::get<ImuReading>(event);
    const ImuVerdict verdict = lane.estimator->process(reading, lane.output);
    if (&lane == &lanes_.front()) count(reading, verdict);
  }
}

void EstimatorRun::count(const ImuReading& reading, ImuVerdict verdict) {
  ++inertial_.verdicts[static_cast<std::size_t>(verdict)];
  if (verdict == ImuVerdict::OutOfOrder || verdict == ImuVerdict::Implausible) return;
  if (last_integrated_) {
    const double dt = secondsBetween(*last_integrated_, reading.stamp);
    inertial_.longest_gap = std::max(inertial_.longest_gap, dt);
    inertial_.mean_period += (dt - inertial_.mean_period) / static_cast<double>(++intervals_);
  }
  last_integrated_ = reading.stamp;
}

void EstimatorRun::finish() {
  settleAll();
  feed();
  for (auto& lane : lanes_) {
    const double begin = cpuSeconds();
    if (lane.estimator) lane.estimator->finish(lane.output);
    lane.seconds += cpuSeconds() - begin;
  }
}

}  // namespace sas_motion::ins
