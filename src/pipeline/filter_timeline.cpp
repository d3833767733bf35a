// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/filter_timeline.hpp"

#include <algorithm>

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/models/towfish_start.hpp"

namespace sas_motion::towfish {
namespace {


template <class Belief, int M>
Audit auditOf(const Measurement& z, const Update<Belief, M>& update) {
  Audit audit;
  audit.stamp = z.stamp;
  audit.sensor = z.sensor;
  audit.rows = M;
  audit.innovation.template head<M>() = update.innovation;
  audit.S.template topLeftCorner<M, M>() = update.S;
  audit.nis = update.nis;
  audit.weights.template head<M>() = update.weights;
  audit.iterations = update.iterations;
  audit.verdict = update.verdict;
  audit.hypotheses = hypothesisWeights(update.belief);
  if (update.verdict == Verdict::Invalid) audit.reason = "numerically singular";
  if (update.verdict == Verdict::Rejected) audit.reason = "outside the gate";
  if (update.verdict == Verdict::DownWeighted) audit.reason = "residual too large for its noise";
  return audit;
}

}  // namespace

template <class Filter>
FilterTimeline<Filter>::FilterTimeline(Make make, const Config& config)
    : make_(std::move(make)),
      config_(config),
      model_(config.model),
      filter_(std::make_shared<const Filter>(make_(config))),
      clock_(config.max_gap, config.lag),
      start_window_(config.start.window) {}

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
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), z, [](const Entry& a, const Measurement& b) { return before(a.z, b); });
  if (place != entries_.end() && !before(z, place->z)) {
    output.audits.push_back(refusal(z, Verdict::Invalid, "duplicate stamp"));
    return;
  }
  const auto index = static_cast<std::size_t>(place - entries_.begin());
  entries_.insert(place, Entry{z, filter_, {}, {}});

  const bool decides_start = started() && !start_settled_ && z.stamp <= start_stamp_;
  if (!started() || decides_start) {
    anchor_.reset();
    if (start()) replay(0);
  } else {
    replay(index);
  }
  settle(entries_.back().z.stamp - stampFromSeconds(config_.lag), output);
}

template <class Filter>
bool FilterTimeline<Filter>::start() {
  if (entries_.empty()) return false;
  const Stamp first = entries_.front().z.stamp;
  const Stamp end = first + stampFromSeconds(start_window_);
  if (entries_.back().z.stamp < end) return false;
  std::vector<Measurement> window;
  for (const auto& entry : entries_)
    if (entry.z.stamp <= end) window.push_back(entry.z);
  const auto belief = startingBelief(first, window, config_.start, config_.model.current_sigma);
  if (!belief) return false;
  anchor_.emplace();
  anchor_->stamp = first;
  anchor_->belief = typename Filter::Belief{*belief};
  start_stamp_ = end;
  return true;
}

template <class Filter>
void FilterTimeline<Filter>::replay(std::size_t first) {
  for (std::size_t i = first; i < entries_.size(); ++i) fuse(momentBefore(i), entries_[i]);
}

template <class Filter>
typename FilterTimeline<Filter>::Moment FilterTimeline<Filter>::predicted(const Moment& from, Stamp stamp) const {
  Moment to = from;
  to.stamp = stamp;
  if (stamp == from.stamp) return to;
  const auto transition = model_.transition(gaussian(from.belief).mean, from.input.at(stamp, config_.input_hold), secondsBetween(from.stamp, stamp));
  to.belief = filter_->predict(from.belief, transition);
  return to;
}

template <class Filter>
void FilterTimeline<Filter>::fuse(const Moment& from, Entry& entry) const {
  const Measurement& z = entry.z;
  entry.after = predicted(from, z.stamp);
  if (z.sensor == Sensor::TurnRate) {
    entry.after.input.take(z);
    entry.audit = refusal(z, Verdict::Accepted, "");
    return;
  }
  model_.linearize(z, gaussian(entry.after.belief).mean, [&](const auto& linear) {
    auto update = entry.filter->update(entry.after.belief, linear);
    entry.audit = auditOf(z, update);
    entry.after.belief = update.belief;
  });
}

template <class Filter>
void FilterTimeline<Filter>::settle(Stamp until, Output& output) {
  const Stamp window = stampFromSeconds(start_window_);
  while (!started() && !entries_.empty() && entries_.front().z.stamp + window <= until) {  // its whole window is here, and does not start
    giveUpFront(output);
    if (start()) replay(0);
  }
  if (!started() || (!start_settled_ && until < start_stamp_)) return;  // a late measurement can still change the start
  while (!entries_.empty() && entries_.front().z.stamp <= until) {
    const Entry& entry = entries_.front();
    settled_ = entry.z.stamp;
    start_settled_ = true;
    const bool last_of_stamp = entries_.size() == 1 || entries_[1].z.stamp != entry.z.stamp;
    if (entry.audit.rows > 0) output.audits.push_back(entry.audit);
    if (last_of_stamp) output.estimates.push_back({entry.z.stamp, gaussian(entry.after.belief)});
    anchor_ = entry.after;
    entries_.pop_front();
  }
}

template <class Filter>
void FilterTimeline<Filter>::giveUpFront(Output& output) {
  settled_ = entries_.front().z.stamp;
  output.audits.push_back(refusal(entries_.front().z, Verdict::Stale, "before the first position and heading"));
  entries_.pop_front();
}

template <class Filter>
void FilterTimeline<Filter>::settleAll(Output& output) {
  if (!entries_.empty()) settle(entries_.back().z.stamp, output);
  while (!entries_.empty()) giveUpFront(output);  // it never started
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
  if (started()) settle(state.stamp, output);
  while (!entries_.empty() && entries_.front().z.stamp <= state.stamp) giveUpFront(output);
  if (!started()) anchor_.emplace();
  anchor_->stamp = state.stamp;  // the turn rate in force stays
  anchor_->belief = typename Filter::Belief{state.belief};
  settled_ = state.stamp;
  replay(0);
  return nullptr;
}

template <class Filter>
void FilterTimeline<Filter>::configure(const Config& config) {
  config_ = config;
  filter_ = std::make_shared<const Filter>(make_(config));
}

template <class Filter>
std::optional<Estimate> FilterTimeline<Filter>::current() const {
  if (!started()) return std::nullopt;
  const Moment& newest = momentBefore(entries_.size());
  return Estimate{newest.stamp, gaussian(newest.belief)};
}

template <class Filter>
std::optional<Estimate> FilterTimeline<Filter>::at(Stamp stamp) const {
  if (!started() || stamp < anchor_->stamp) return std::nullopt;
  const auto after = std::upper_bound(entries_.begin(), entries_.end(), stamp, [](Stamp s, const Entry& entry) { return s < entry.z.stamp; });
  return Estimate{stamp, gaussian(predicted(momentBefore(static_cast<std::size_t>(after - entries_.begin())), stamp).belief)};
}

template <class Filter>
void FilterTimeline<Filter>::reset() {
  forget();
  clock_.reset();
  start_window_ = config_.start.window;
}

template <class Filter>
void FilterTimeline<Filter>::forget() {
  entries_.clear();
  anchor_.reset();
  settled_.reset();
  start_settled_ = false;
}

template class FilterTimeline<BankKalmanFilter<kStates>>;
template class FilterTimeline<GaussianSumFilter<kStates>>;
template class FilterTimeline<KalmanFilter<kStates>>;
template class FilterTimeline<ReacquiringFilter<GatedKalmanFilter<kStates>, kStates>>;
template class FilterTimeline<ReacquiringFilter<MixtureKalmanFilter<kStates>, kStates>>;
template class FilterTimeline<ReacquiringFilter<CalibratedFilter<RobustKalmanFilter<kStates>, kStates>, kStates>>;
template class FilterTimeline<ReacquiringFilter<CalibratedFilter<StudentTKalmanFilter<kStates>, kStates>, kStates>>;

}  // namespace sas_motion::towfish
