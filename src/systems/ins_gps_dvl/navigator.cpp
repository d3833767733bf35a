// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/navigator.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/filter_by_name.hpp"

namespace sas_motion::ins {
namespace {

bool before(const Aiding& a, const Aiding& b) { return a.stamp < b.stamp; }

}  // namespace

Errors gapVariance(const BridgedGap& bridge, double gap, double part) {
  Errors variance = Errors::Zero();
  variance.head<9>() = bridge.variance(gap, part);
  variance.segment<3>(kAttitude) /= kMilliradian * kMilliradian;
  return variance;
}

template <int M>
Update<Gaussian<kStates>, M> Unaided::update(const Gaussian<kStates>& prior,
                                             const LinearMeasurement<kStates, M>& z) const {
  return examine(prior, z);
}

template <class Filter>
Navigator<Filter>::Navigator(const Filter& filter, const Parameters& parameters, const NavigationState& start,
                             Stamp stamp, const Options& options)
    : filter_(filter),
      model_(parameters, start),
      options_(options),
      ins_(start, stamp, options.imu),
      belief_(model_.start()),
      reckoned_(start),
      steady_(start, options.steady) {}

template <class Filter>
ImuStep Navigator<Filter>::add(const ImuReading& reading) {
  audits_.clear();
  const ImuStep step{ins_.judge(reading), secondsBetween(ins_.stamp(), reading.stamp)};
  if (step.verdict == ImuVerdict::Implausible || step.verdict == ImuVerdict::OutOfOrder) return {step.verdict, 0};
  gps_.reset();
  std::stable_sort(waiting_.begin(), waiting_.end(), before);
  gap_ = step.verdict == ImuVerdict::Bridged ? step.dt : 0;
  for (; !waiting_.empty() && waiting_.front().stamp <= reading.stamp; waiting_.pop_front()) {
    const Aiding& next = waiting_.front();
    if (next.stamp < ins_.stamp()) {
      audits_.push_back(refusal(next, Verdict::Stale, "older than the IMU's last reading"));
      continue;
    }
    advance(reading, next.stamp);
    predict();
    fuse(next);
  }
  advance(reading, reading.stamp);
  return step;
}

template <class Filter>
void Navigator<Filter>::advance(const ImuReading& reading, Stamp stamp) {
  const double dt = secondsBetween(ins_.stamp(), stamp);
  ins_.advance(reading, stamp);
  if (!(dt > 0)) return;
  const NavigationState& state = ins_.state();
  const Matrix<3> C = state.q_nav_body.toRotationMatrix();
  since_ += dt;
  force_sum_ += dt * ins_.force_nav();
  velocity_sum_ += dt * state.velocity_nav;
  C_sum_ += dt * C;
  displace(reckoned_, dt * (velocity_body_ ? Vector<3>(C * *velocity_body_) : state.velocity_nav));
  if (since_ > options_.step - 1e-9 || gap_ > 0) predict();
  steady_.move(fused(), dt);
  if (gap_ > 0) widenForGap(dt);
}

template <class Filter>
void Navigator<Filter>::predict() {
  if (!(since_ > 0)) return;
  ErrorModel::Motion motion{ins_.state(), force_sum_ / since_, C_sum_ / since_};
  motion.state.velocity_nav = velocity_sum_ / since_;
  belief_ = filter_.predict(belief_, model_.transition(motion, since_, belief_.mean));
  since_ = 0;
  force_sum_.setZero();
  velocity_sum_.setZero();
  C_sum_.setZero();
}

template <class Filter>
void Navigator<Filter>::fuse(const Aiding& reading) {
  const NavigationState& ins = ins_.state();
  if (reading.lever_body) model_.place(reading.sensor, *reading.lever_body);
  const auto update = [&](auto z) {
    if (reading.variance) z.R = reading.variance->head(z.R.rows()).asDiagonal();
    const auto result = filter_.update(belief_, z);
    belief_ = result.belief;
    audits_.push_back(auditOf(reading.stamp, sensorName(reading.sensor), result));
  };
  switch (reading.sensor) {
    case Sensor::Gps: {
      update(model_.gps(ins, reading.fix, belief_.mean));
      Fix fix{reading.stamp, reading.fix};
      fix.state.q_nav_body = fused().q_nav_body;
      const Errors& mean = belief_.mean;
      displace(fix.state, -(fix.state.q_nav_body * model_.parameters().gps_lever_body) - mean.segment<3>(kGpsPosition));
      gps_ = fix;
      break;
    }
    case Sensor::Dvl:
      update(model_.dvl(ins, ins_.rate_body(), reading.velocity_body, belief_.mean));
      velocity_body_ = model_.velocityOfIns(ins, ins_.rate_body(), reading.velocity_body);
      break;
    case Sensor::Depth: update(model_.depth(ins, reading.fix.height, belief_.mean)); break;
    case Sensor::Dpc: update(model_.dpc(ins, ins_.rate_body(), reading.array, belief_.mean)); break;
  }
  steady_.jump(fused());
  if (options_.feedback) feedBack();
}

template <class Filter>
NavigationState Navigator<Filter>::dvl() const {
  NavigationState state = reckoned_;
  displace(state, -belief_.mean.template segment<3>(kDvlPosition));
  state.q_nav_body = fused().q_nav_body;
  if (velocity_body_)
    state.velocity_nav = state.q_nav_body * (*velocity_body_ - model_.dvlError(*velocity_body_, belief_.mean));
  return state;
}

template <class Filter>
void Navigator<Filter>::widenForGap(double part) {
  addCovariance(belief_, ErrorMatrix(gapVariance(options_.bridge, gap_, part).asDiagonal()));
}

template <class Filter>
void Navigator<Filter>::feedBack() {
  ins_.reset(fused());
  belief_.mean.template head<9>().setZero();
}

#define SAS_MOTION_INSTANTIATE(Filter) template class Navigator<Filter<kStates>>;
SAS_MOTION_FOR_LARGE_FILTERS(SAS_MOTION_INSTANTIATE)
template class Navigator<Unaided>;

}  // namespace sas_motion::ins
