// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/filter_history.hpp"

#include <algorithm>

#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"

namespace sas_motion::towfish {
template <class Filter>
void FilterHistory<Filter>::use(std::shared_ptr<const Filter> filter, double input_hold) {
  filter_ = std::move(filter);
  input_hold_ = input_hold;
}

template <class Filter>
std::optional<std::size_t> FilterHistory<Filter>::insert(const Measurement& z) {
  const auto place = std::lower_bound(entries_.begin(), entries_.end(), z,
                                      [](const Entry& a, const Measurement& b) { return towfish::before(a.z, b); });
  if (place != entries_.end() && !towfish::before(z, place->z)) return std::nullopt;
  const auto index = place - entries_.begin();
  entries_.emplace(place, z, filter_);
  return static_cast<std::size_t>(index);
}

template <class Filter>
void FilterHistory<Filter>::startWith(Stamp stamp, const typename Filter::Belief& belief) {
  const HeldInput input = start_ ? start_->input : HeldInput{};
  start_.emplace(stamp, belief, input);
  fuseFrom(0);
}

template <class Filter>
void FilterHistory<Filter>::fuseFrom(std::size_t first) {
  for (std::size_t i = first; i < entries_.size(); ++i) fuse(before(i), entries_[i]);
}

template <class Filter>
typename Filter::Belief FilterHistory<Filter>::predicted(const Moment& from, Stamp stamp) const {
  return filter_->predict(from.belief,
                          motion_(gaussian(from.belief).mean, from.input.at(stamp, input_hold_), from.stamp, stamp));
}

template <class Filter>
void FilterHistory<Filter>::fuse(const Moment& from, Entry& entry) const {
  if (entry.z.stamp == from.stamp)
    fuse(from.belief, from.input, entry);
  else
    fuse(predicted(from, entry.z.stamp), from.input, entry);
}

template <class Filter>
void FilterHistory<Filter>::fuse(const typename Filter::Belief& prior, const HeldInput& input, Entry& entry) const {
  const Measurement& z = entry.z;
  if (z.sensor == Sensor::TurnRate) {
    entry.after.emplace(z.stamp, prior, input);
    entry.after->input.take(z);
    entry.audit = refusal(z, Verdict::Accepted, "");
    return;
  }
  model_.linearize(z, gaussian(prior).mean, [&](const auto& linear) {
    const auto update = entry.filter->update(prior, linear);
    entry.audit = auditOf(z.stamp, sensorName(z.sensor), update);
    entry.after.emplace(z.stamp, update.belief, input);
  });
}

template <class Filter>
void FilterHistory<Filter>::settle(std::size_t count) {
  if (count == 0) return;
  start_ = entries_[count - 1].after;
  entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(count));
}

template <class Filter>
void FilterHistory<Filter>::forget() {
  entries_.clear();
  start_.reset();
}

template <class Filter>
Gaussian<kStates> FilterHistory<Filter>::at(Stamp stamp) const {
  const auto after = std::upper_bound(entries_.begin(), entries_.end(), stamp,
                                      [](Stamp s, const Entry& entry) { return s < entry.z.stamp; });
  const Moment& from = before(static_cast<std::size_t>(after - entries_.begin()));
  return stamp == from.stamp ? gaussian(from.belief) : gaussian(predicted(from, stamp));
}

#define SAS_MOTION_INSTANTIATE(Filter) template class FilterHistory<Guarded<Filter<kStates>>>;
SAS_MOTION_FOR_FILTERS(SAS_MOTION_INSTANTIATE)
template class FilterHistory<GaussianSumFilter<kStates>>;

}  // namespace sas_motion::towfish
