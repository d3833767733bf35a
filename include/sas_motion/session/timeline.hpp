// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/session/present.hpp"

namespace sas_motion {

/// One estimator over readings that come in any order, live or from a bag.
///
/// What it writes to Output is settled: no reading inside the lag can change it any more, so it depends on the readings
/// alone and not on the order in which they arrived. current() is the best answer at this moment. When the clock is
/// set, or after a long gap, the estimator starts anew.
///
/// Beside the functions that ReadingQueue needs, a system defines for its Reading: invalidity(r, config), the reason
/// why it cannot be used as a literal, or null; and refusalOf(r, verdict, reason), its audit, where it has one.
template <class Estimator>
class Timeline {
 public:
  using Reading = typename Estimator::Reading;
  using State = typename Estimator::State;
  using Config = typename Estimator::Config;
  using Output = typename Estimator::Output;
  using Queue = ReadingQueue<Reading, Config>;

  /// A stamp more than `max_gap` ahead of all others is not accepted alone [s]. `keeps_present`: else there are only
  /// settled answers, in half the time.
  Timeline(std::unique_ptr<Estimator> estimator, const Config& config, double max_gap, bool keeps_present = true)
      : config_(std::make_shared<Config>(config)),
        queue_(estimator->lag(), max_gap),
        settled_{std::move(estimator), config_},
        keeps_present_(keeps_present && settled_.estimator->keepsPresent()) {}

  /// Takes one reading, of any age. Data never throws.
  void process(const Reading& reading, Output& output) {
    if (const char* reason = invalidity(reading, *config_)) {
      refuse(reading, Verdict::Invalid, reason, output);
      return;
    }
    const auto answer = queue_.insert({reading, config_}, refuser(output));
    if (answer == Queue::Answer::NotTaken) return;
    if (answer == Queue::Answer::ClockSet) startAnew(output);
    const std::size_t count = queue_.settling();
    settle(count, output);
    if (answer == Queue::Answer::Taken)
      follow(count);
    else
      restartPresent();
  }
  /// The end of the data, or a pause: settles everything that is still open.
  void finish(Output& output) {
    queue_.refuseHeld(refuser(output));
    const auto first = static_cast<std::ptrdiff_t>(output.audits.size());
    const std::size_t count = queue_.open().size();
    settle(count, output);
    present_.settle(count);
    settled_.estimator->finish(output);
    std::stable_sort(output.audits.begin() + first, output.audits.end(),
                     [](const Audit& a, const Audit& b) { return a.stamp < b.stamp; });
    if (corrections_ != settled().corrections()) restartPresent();
  }
  /// Sets the state at a stamp: what was measured after it is fused again, what was measured before it is settled as it
  /// was. Returns the reason why not as a literal, or null.
  const char* setState(const typename Estimator::Start& start, Output& output) {
    if (!settled_.estimator->keepsPresent()) return "it keeps no present state";
    if (queue_.hasSettledAfter(start.stamp)) return "the stamp is older than the lag";
    if (!queue_.nearNewest(start.stamp)) return "the stamp is far from those of the measurements";
    settle(queue_.countUntil(start.stamp), output);
    settled_.estimator->setState(start, output);
    queue_.settleUntil(start.stamp);
    present_ = {};
    restartPresent();
    return nullptr;
  }
  /// Other settings, for readings that come from now on.
  void configure(const Config& config) { config_ = std::make_shared<Config>(config); }

  /// The newest state, or nothing before the start and where the estimator keeps none.
  const std::optional<State>& current() const { return present_.current(); }
  /// The state at any stamp inside the lag or after the newest reading, or nothing.
  std::optional<State> at(Stamp stamp) const {
    return keeps_present_ ? present_.at(settled_, queue_, stamp) : std::nullopt;
  }
  const Estimator& settled() const { return *settled_.estimator; }
  /// How many readings without an audit were refused for this reason.
  std::uint64_t refused(typename Queue::Refusal why) const { return refused_[static_cast<std::size_t>(why)]; }

 private:
  auto refuser(Output& output) {
    return [this, &output](const Reading& reading, typename Queue::Refusal why) { refuse(reading, why, output); };
  }
  void refuse(const Reading& reading, typename Queue::Refusal why, Output& output) {
    using Refusal = typename Queue::Refusal;
    const char* reason = why == Refusal::Late  ? "older than the lag"
                         : why == Refusal::Far ? "stamp far ahead of the others"
                                               : "duplicate stamp";
    const bool audited = refuse(reading, why == Refusal::Late ? Verdict::Stale : Verdict::Invalid, reason, output);
    if (!audited) ++refused_[static_cast<std::size_t>(why)];
  }
  bool refuse(const Reading& reading, Verdict verdict, const char* reason, Output& output) {
    const auto audit = refusalOf(reading, verdict, reason);
    if (audit) output.audits.push_back(*audit);
    return audit.has_value();
  }

  void settle(std::size_t count, Output& output) {
    const auto& open = queue_.open();
    for (std::size_t i = 0; i < count; ++i) {
      if (queue_.isDuplicate(i))
        refuse(open[i].reading, Queue::Refusal::Duplicate, output);
      else
        settled_.take(open[i], output);
      if (i + 1 == open.size() || stampOf(open[i + 1].reading) != stampOf(open[i].reading))
        settled_.estimator->endStamp(output);
    }
    queue_.drop(count);
  }
  void startAnew(Output& output) {
    settle(queue_.open().size(), output);
    settled_.estimator->startAnew(output);
    present_ = {};
    queue_.startAnew(config_);
  }
  /// After a reading was taken, and the first ones settled.
  void follow(std::size_t settled) {
    const bool settled_at_once = queue_.place() < settled, corrected = corrections_ != this->settled().corrections();
    if (settled_at_once || corrected) return restartPresent();
    present_.settle(settled);
    if (keeps_present_) present_.insert(settled_, queue_, queue_.place() - settled);
  }
  void restartPresent() {
    corrections_ = settled().corrections();
    if (keeps_present_) present_.restart(settled_, queue_);
  }

  std::shared_ptr<const Config> config_;
  Queue queue_;
  Running<Estimator> settled_;
  Present<Estimator> present_;
  bool keeps_present_;
  std::uint64_t corrections_ = 0;  // that the present has followed
  std::array<std::uint64_t, 3> refused_{};
};

}  // namespace sas_motion
