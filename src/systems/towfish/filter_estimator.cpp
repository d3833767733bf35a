// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/filter_estimator.hpp"

#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"

namespace sas_motion::towfish {
namespace {

Motion motionOf(const Model& model) {
  return [model](const StateVector& mean, const Input& input, Stamp from, Stamp to) {
    return model.transition(mean, input, secondsBetween(from, to));
  };
}

}  // namespace

template <class Filter>
FilterEstimator<Filter>::FilterEstimator(Make make, const Config& config)
    : FilterEstimator(std::move(make), config, motionOf(Model(config.model))) {}

template <class Filter>
FilterEstimator<Filter>::FilterEstimator(Make make, const Config& config, Motion motion)
    : setup_(std::make_shared<Setup>(Setup{make, config, Model(config.model), std::move(motion), make(config)})),
      start_(config) {}

template <class Filter>
FilterEstimator<Filter>::FilterEstimator(Make make, const Config& config, const Estimate& estimate,
                                         const HeldInput& input)
    : FilterEstimator(std::move(make), config) {
  now_.emplace(Moment{estimate.stamp, typename Filter::Belief{estimate.belief}});
  input_ = input;
}

template <class Filter>
void FilterEstimator<Filter>::process(const Measurement& z, Output& output) {
  if (now_)
    fuse(z, output);
  else
    start_.add(z);
}

template <class Filter>
void FilterEstimator<Filter>::endStamp(Output& output) {
  if (now_) return putOut(output);
  const auto start = start_.find(output);
  if (!start) return;
  now_.emplace(Moment{start_.gathered().front().stamp, typename Filter::Belief{*start}});
  for (const auto& z : start_.gathered()) {
    if (z.stamp > now_->stamp) putOut(output);
    fuse(z, output);
  }
  putOut(output);
  start_.clear();
}

template <class Filter>
void FilterEstimator<Filter>::fuse(const Measurement& z, Output& output) {
  advance(z.stamp);
  if (z.sensor == Sensor::TurnRate) return input_.take(z);
  setup_->model.linearize(z, gaussian(now_->belief).mean, [&](const auto& linear) {
    auto update = setup_->filter.update(now_->belief, linear);
    output.audits.push_back(auditOf(z.stamp, sourceName(z), update));
    now_->belief = std::move(update.belief);
  });
}

template <class Filter>
void FilterEstimator<Filter>::advance(Stamp stamp) {
  if (stamp == now_->stamp) return;
  const Input input = input_.at(stamp, setup_->config.input_hold);
  const auto motion = setup_->motion(gaussian(now_->belief).mean, input, now_->stamp, stamp);
  now_ = Moment{stamp, setup_->filter.predict(now_->belief, motion)};
}

template <class Filter>
void FilterEstimator<Filter>::putOut(Output& output) const {
  output.solutions.push_back({now_->stamp, gaussian(now_->belief)});
}

template <class Filter>
void FilterEstimator<Filter>::finish(Output& output) {
  start_.refuseAll(output);
}

template <class Filter>
void FilterEstimator<Filter>::startAnew(Output& output) {
  start_.refuseAll(output);
  start_.shorten();
  now_.reset();
  input_ = {};
}

template <class Filter>
void FilterEstimator<Filter>::setState(const Estimate& state, Output& output) {
  start_.refuseAll(output);
  now_.emplace(Moment{state.stamp, typename Filter::Belief{state.belief}});
}

template <class Filter>
void FilterEstimator<Filter>::configure(const Config& config) {
  setup_ = std::make_shared<Setup>(Setup{setup_->make, config, setup_->model, setup_->motion, setup_->make(config)});
}

template <class Filter>
std::optional<Estimate> FilterEstimator<Filter>::predictedTo(Stamp stamp, const Measurement*) {
  if (!now_ || stamp < now_->stamp) return std::nullopt;
  advance(stamp);
  return Estimate{stamp, gaussian(now_->belief)};
}

#define SAS_MOTION_INSTANTIATE(Filter) template class FilterEstimator<Guarded<Filter<kStates>>>;
SAS_MOTION_FOR_FILTERS(SAS_MOTION_INSTANTIATE)
template class FilterEstimator<GaussianSumFilter<kStates>>;

}  // namespace sas_motion::towfish
