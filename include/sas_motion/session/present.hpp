// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/session/in_order.hpp"
#include "sas_motion/session/reading_queue.hpp"

namespace sas_motion {

/// An estimator with the settings that it was last given.
template <class Estimator>
struct Running {
  using Config = typename Estimator::Config;

  std::unique_ptr<Estimator> estimator;
  std::shared_ptr<const Config> config;

  template <class Entry>
  void take(const Entry& entry, typename Estimator::Output& output) {
    if (entry.config != config) {
      estimator->configure(*entry.config);
      config = entry.config;
    }
    estimator->process(entry.reading, output);
  }
  Running clone() const { return {estimator->clone(), config}; }
};

/// The present of an estimator: a copy of the settled one, carried on through the readings whose order can still
/// change. Where one comes late, it goes back to a copy from before it and takes the readings after that again, so that
/// any order of arrival gives the same present. An estimator that cannot be copied has none.
template <class Estimator>
class Present {
 public:
  using State = typename Estimator::State;
  using Queue = ReadingQueue<typename Estimator::Reading, typename Estimator::Config>;

  /// Goes on from `settled`, which has taken everything but the open readings.
  void restart(const Running<Estimator>& settled, const Queue& queue) {
    checkpoints_.clear();
    replay(settled, queue, 0);
    if (!running_.estimator || !queue.open().empty()) return;
    output_.clear();
    running_.estimator->endStamp(output_);
    if (!output_.solutions.empty()) current_ = output_.solutions.back();
  }
  /// The first open readings have settled, and are no longer among them.
  void settle(std::size_t count) {
    while (!checkpoints_.empty() && checkpoints_.front().next <= count) checkpoints_.pop_front();
    for (auto& checkpoint : checkpoints_) checkpoint.next -= count;
  }
  /// One more is open, at this place.
  void insert(const Running<Estimator>& settled, const Queue& queue, std::size_t place) {
    if (running_.estimator && place + 1 == queue.open().size())
      take(queue, place);
    else
      replay(settled, queue, place);
  }

  /// The newest state, or nothing before the start.
  const std::optional<State>& current() const { return current_; }
  /// The state at any stamp from the last settled one on; nothing further ahead than the estimator predicts.
  std::optional<State> at(const Running<Estimator>& settled, const Queue& queue, Stamp stamp) const {
    const auto& open = queue.open();
    const Checkpoint* from = nullptr;
    for (const auto& checkpoint : checkpoints_)
      if (stampOf(open[checkpoint.next - 1].reading) < stamp) from = &checkpoint;
    Running<Estimator> copy = (from ? from->running : settled).clone();
    if (!copy.estimator) return std::nullopt;
    typename Estimator::Output output;
    std::size_t next = from ? from->next : 0;
    for (; next < open.size() && stampOf(open[next].reading) <= stamp; ++next) give(copy, queue, next, output);
    if (!output.solutions.empty() && output.solutions.back().stamp == stamp) return output.solutions.back();
    const auto later = std::find_if(open.begin() + static_cast<std::ptrdiff_t>(next), open.end(),
                                    [](const auto& entry) { return tellsTime(entry.reading); });
    return copy.estimator->predictedTo(stamp, later == open.end() ? nullptr : &later->reading);
  }

 private:
  static constexpr double kBetweenCheckpoints = 0.25;  // [s]
  struct Checkpoint {
    std::size_t next;  // the first open reading that it has not taken
    Running<Estimator> running;
  };

  static void give(Running<Estimator>& to, const Queue& queue, std::size_t place, typename Estimator::Output& output) {
    output.clear();
    if (queue.isDuplicate(place)) return;
    to.take(queue.open()[place], output);
    to.estimator->endStamp(output);
  }

  /// From the last checkpoint that has taken none of the readings from this place on.
  void replay(const Running<Estimator>& settled, const Queue& queue, std::size_t place) {
    while (!checkpoints_.empty() && checkpoints_.back().next > place) checkpoints_.pop_back();
    running_ = (checkpoints_.empty() ? settled : checkpoints_.back().running).clone();
    last_checkpoint_.reset();
    const std::size_t first = checkpoints_.empty() ? 0 : checkpoints_.back().next;
    for (std::size_t i = first; running_.estimator && i < queue.open().size(); ++i) take(queue, i);
  }

  void take(const Queue& queue, std::size_t place) {
    give(running_, queue, place, output_);
    if (!output_.solutions.empty()) current_ = output_.solutions.back();
    const Stamp stamp = stampOf(queue.open()[place].reading);
    if (last_checkpoint_ && secondsBetween(*last_checkpoint_, stamp) < kBetweenCheckpoints) return;
    checkpoints_.push_back({place + 1, running_.clone()});
    last_checkpoint_ = stamp;
  }

  std::deque<Checkpoint> checkpoints_;  // in order
  Running<Estimator> running_;
  std::optional<State> current_;
  std::optional<Stamp> last_checkpoint_;
  typename Estimator::Output output_;
};

}  // namespace sas_motion
