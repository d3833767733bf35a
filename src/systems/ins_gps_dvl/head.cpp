// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/head.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kBetweenCheckpoints = 0.25;  // [s]
constexpr double kFurthest = 1;  // beyond the newest reading of the inertial unit that a state is predicted to [s]

/// Hands over a reading; the newest solution, where there is one.
std::optional<NavigationSolution> give(Estimator& estimator, const Reading& reading, Output& output) {
  output.clear();
  if (const auto* aiding = std::get_if<Aiding>(&reading)) estimator.process(*aiding, output);
  if (const auto* inertial = std::get_if<InertialReading>(&reading)) estimator.process(inertial->imu, output);
  return output.solutions.empty() ? std::nullopt : std::optional(output.solutions.back());
}

const ImuReading* unitOf(const Reading& reading) {
  const auto* inertial = std::get_if<InertialReading>(&reading);
  return inertial ? &inertial->imu : nullptr;
}

}  // namespace

void Head::forget() {
  checkpoints_.clear();
  estimator_.reset();
  current_.reset();
  last_checkpoint_.reset();
}

void Head::restart(const Estimator& settled, const Readings& open) {
  forget();
  replay(settled, open, 0);
}

void Head::settle(std::size_t count) {
  while (!checkpoints_.empty() && checkpoints_.front().next <= count)
    checkpoints_.pop_front();  // the settled one has taken as much
  for (auto& checkpoint : checkpoints_) checkpoint.next -= count;
}

void Head::insert(const Estimator& settled, const Readings& open, std::size_t place) {
  if (place + 1 < open.size())
    replay(settled, open, place);
  else if (estimator_)
    take(open, place);
}

/// From the last checkpoint that has taken none of the readings from this place on.
void Head::replay(const Estimator& settled, const Readings& open, std::size_t place) {
  while (!checkpoints_.empty() && checkpoints_.back().next > place) checkpoints_.pop_back();
  estimator_ = checkpoints_.empty() ? settled.clone() : checkpoints_.back().estimator->clone();
  last_checkpoint_.reset();
  const std::size_t first = checkpoints_.empty() ? 0 : checkpoints_.back().next;
  if (estimator_)
    for (std::size_t i = first; i < open.size(); ++i) take(open, i);
}

void Head::take(const Readings& open, std::size_t place) {
  const Reading& reading = open[place];
  if (const auto solution = give(*estimator_, reading, output_)) current_ = solution;
  if (!unitOf(reading)) return;
  const Stamp stamp = stampOf(reading);
  if (last_checkpoint_ && secondsBetween(*last_checkpoint_, stamp) < kBetweenCheckpoints) return;
  checkpoints_.push_back({place + 1, estimator_->clone()});
  last_checkpoint_ = stamp;
}

std::optional<NavigationSolution> Head::at(const Estimator& settled, const Readings& open, Stamp stamp,
                                           double furthest) const {
  if (!estimator_) return std::nullopt;
  const Checkpoint* from = nullptr;
  for (const auto& checkpoint : checkpoints_)
    if (stampOf(open[checkpoint.next - 1]) <= stamp) from = &checkpoint;
  const auto estimator = from ? from->estimator->clone() : settled.clone();
  std::size_t next = from ? from->next : 0;
  const ImuReading* means = from ? unitOf(open[next - 1]) : nullptr;  // of the interval that the stamp is in
  Output output;
  std::optional<NavigationSolution> solution;
  for (; next < open.size() && stampOf(open[next]) <= stamp; ++next) {
    solution = give(*estimator, open[next], output);
    if (const ImuReading* unit = unitOf(open[next])) means = unit;
  }
  if (solution && solution->stamp == stamp) return solution;
  while (next < open.size() && !unitOf(open[next])) ++next;
  if (next < open.size()) means = unitOf(open[next]);
  if (!means || secondsBetween(means->stamp, stamp) > furthest) return std::nullopt;
  solution = give(*estimator, InertialReading{{stamp, means->rate_body, means->force_body}, {}}, output);
  return solution && solution->stamp == stamp ? solution : std::nullopt;
}

ReadingQueue::Answer LiveRun::process(const Reading& reading) {
  if (!keeps_present_) return run_.process(reading);
  const std::size_t before = run_.queue().open().size();
  const auto answer = run_.process(reading);
  const bool taken = answer == ReadingQueue::Answer::Taken;
  const std::size_t now = run_.queue().open().size(),
                    settled = answer == ReadingQueue::Answer::ClockSet ? 0 : before + (taken ? 1 : 0) - now;
  run_.feed();
  for (std::size_t lane = 0; lane < heads_.size(); ++lane) update(lane, taken, settled);
  return answer;
}

void LiveRun::update(std::size_t lane, bool taken, std::size_t settled) {
  const auto& of = run_.lanes()[lane];
  const auto& open = run_.queue().open();
  Head& head = heads_[lane];
  if (!run_.alignment().started() || !of.estimator) return head.forget();
  const bool anew = starts_[lane] != of.starts || (taken && run_.queue().place() < settled);
  starts_[lane] = of.starts;
  if (anew) return head.restart(*of.estimator, open);
  head.settle(settled);
  if (taken) head.insert(*of.estimator, open, run_.queue().place() - settled);
}

void LiveRun::finish() {
  const std::size_t settled = run_.queue().open().size();
  run_.finish();
  if (!keeps_present_) return;
  for (std::size_t lane = 0; lane < heads_.size(); ++lane) update(lane, false, settled);
}

void LiveRun::startAt(std::size_t lane, const Start& start) {
  const std::size_t before = run_.queue().open().size();
  run_.startAt(lane, start);
  const std::size_t settled = before - run_.queue().open().size();
  for (std::size_t i = 0; i < heads_.size(); ++i) update(i, false, settled);
}

void LiveRun::configure(const Config& config) {
  run_.configure(config);
  for (std::size_t i = 0; i < heads_.size(); ++i)
    if (const auto& estimator = run_.lanes()[i].estimator) heads_[i].restart(*estimator, run_.queue().open());
}

std::optional<NavigationSolution> LiveRun::at(std::size_t lane, Stamp stamp) const {
  const auto& of = run_.lanes()[lane];
  return of.estimator ? heads_[lane].at(*of.estimator, run_.queue().open(), stamp, kFurthest) : std::nullopt;
}

}  // namespace sas_motion::ins
