// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/filter_timeline.hpp"

#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/systems/towfish/start.hpp"

namespace sas_motion::towfish {
namespace {

Motion motionOf(const Model& model) {
  return [model](const StateVector& mean, const Input& input, Stamp from, Stamp to) {
    return model.transition(mean, input, secondsBetween(from, to));
  };
}

}  // namespace

template <class Filter>
FilterTimeline<Filter>::FilterTimeline(Make make, const Config& config)
    : FilterTimeline(std::move(make), config, motionOf(Model(config.model))) {}

template <class Filter>
FilterTimeline<Filter>::FilterTimeline(Make make, const Config& config, Motion motion)
    : make_(std::move(make)),
      config_(config),
      clock_(config.max_gap, config.lag),
      history_(Model(config.model), std::move(motion)),
      start_window_(config.start.window) {
  configure(config);
}

template <class Filter>
void FilterTimeline<Filter>::process(const Measurement& z, Output& output) {
  if (const char* reason = invalidity(z, config_)) {
    output.audits.push_back(refusal(z, Verdict::Invalid, reason));
    return;
  }
  const auto answer = clock_.judge(z, output);
  if (answer == ClockGuard::Answer::ClockSet) startAnew(output);
  if (answer == ClockGuard::Answer::Believed) insert(z, output);
}

template <class Filter>
void FilterTimeline<Filter>::startAnew(Output& output) {
  const auto agreed = clock_.release();
  settleAll(output);
  forget();
  start_window_ = config_.start.window * ClockGuard::kShortenedStart;
  for (const auto& z : agreed) insert(z, output);
}

template <class Filter>
void FilterTimeline<Filter>::insert(const Measurement& z, Output& output) {
  if (settled_ && z.stamp <= *settled_) {
    output.audits.push_back(refusal(z, Verdict::Stale, "older than the lag"));
    return;
  }
  const auto place = history_.insert(z);
  if (!place) {
    output.audits.push_back(refusal(z, Verdict::Invalid, "duplicate stamp"));
    return;
  }
  const bool decides_start = !start_settled_ && z.stamp <= start_stamp_;
  if (history_.started() && decides_start) history_.forgetStart();
  if (history_.started())
    history_.fuseFrom(*place);
  else
    start();
  settle(history_.entries().back().z.stamp - stampFromSeconds(config_.lag), output);
}

template <class Filter>
void FilterTimeline<Filter>::start() {
  const auto& entries = history_.entries();
  if (entries.empty()) return;
  const Stamp first = entries.front().z.stamp, end = first + stampFromSeconds(start_window_);
  if (entries.back().z.stamp < end) return;
  std::vector<Measurement> window;
  for (const auto& entry : entries)
    if (entry.z.stamp <= end) window.push_back(entry.z);
  const auto belief = startingBelief(first, window, config_.start, config_.model.current_sigma);
  if (!belief) return;
  history_.startWith(first, typename Filter::Belief{*belief});
  start_stamp_ = end;
}

template <class Filter>
void FilterTimeline<Filter>::settle(Stamp until, Output& output) {
  const Stamp window = stampFromSeconds(start_window_);
  const auto& entries = history_.entries();
  while (!history_.started() && !entries.empty() &&
         entries.front().z.stamp + window <= until) {  // its whole window is here, and does not start
    giveUpFront(output);
    start();
  }
  if (!history_.started() || (!start_settled_ && until < start_stamp_))
    return;  // a late measurement can still change the start
  std::size_t count = 0;
  for (; count < entries.size() && entries[count].z.stamp <= until; ++count) {
    const Entry& entry = entries[count];
    const bool last_of_stamp = count + 1 == entries.size() || entries[count + 1].z.stamp != entry.z.stamp;
    if (entry.audit.rows > 0) output.audits.push_back(entry.audit);
    if (last_of_stamp) output.solutions.push_back({entry.z.stamp, gaussian(entry.after->belief)});
    settled_ = entry.z.stamp;
    start_settled_ = true;
  }
  history_.settle(count);
}

template <class Filter>
void FilterTimeline<Filter>::giveUpFront(Output& output) {
  const Measurement& z = history_.entries().front().z;
  settled_ = z.stamp;
  output.audits.push_back(refusal(z, Verdict::Stale, "before the first position and heading"));
  history_.dropFront();
}

template <class Filter>
void FilterTimeline<Filter>::settleAll(Output& output) {
  if (!history_.entries().empty()) settle(history_.entries().back().z.stamp, output);
  while (!history_.entries().empty()) giveUpFront(output);  // it never started
}

template <class Filter>
void FilterTimeline<Filter>::finish(Output& output) {
  clock_.refuseHeld(output);
  settleAll(output);
}

template <class Filter>
const char* FilterTimeline<Filter>::setState(const Estimate& state, Output& output) {
  if (settled_ && state.stamp < *settled_) return "the stamp is older than the lag";
  if (!clock_.believable(state.stamp)) return "the stamp is far from those of the measurements";
  clock_.believe(state.stamp);
  start_settled_ = true;
  if (history_.started()) settle(state.stamp, output);
  while (!history_.entries().empty() && history_.entries().front().z.stamp <= state.stamp) giveUpFront(output);
  history_.startWith(state.stamp, typename Filter::Belief{state.belief});
  settled_ = state.stamp;
  return nullptr;
}

template <class Filter>
void FilterTimeline<Filter>::configure(const Config& config) {
  config_ = config;
  history_.use(std::make_shared<const Filter>(make_(config)), config.input_hold);
}

template <class Filter>
std::optional<Estimate> FilterTimeline<Filter>::current() const {
  if (!history_.started()) return std::nullopt;
  const auto& newest = history_.newest();
  return Estimate{newest.stamp, gaussian(newest.belief)};
}

template <class Filter>
std::optional<Estimate> FilterTimeline<Filter>::at(Stamp stamp) const {
  if (!history_.started() || stamp < history_.startStamp()) return std::nullopt;
  return Estimate{stamp, history_.at(stamp)};
}

template <class Filter>
void FilterTimeline<Filter>::reset() {
  forget();
  clock_.reset();
  start_window_ = config_.start.window;
}

template <class Filter>
void FilterTimeline<Filter>::forget() {
  history_.forget();
  settled_.reset();
  start_settled_ = false;
}

#define SAS_MOTION_INSTANTIATE(Filter) template class FilterTimeline<Guarded<Filter<kStates>>>;
SAS_MOTION_FOR_FILTERS(SAS_MOTION_INSTANTIATE)
template class FilterTimeline<GaussianSumFilter<kStates>>;

}  // namespace sas_motion::towfish
