// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/chain.hpp"

#include <algorithm>

namespace sas_motion::ins {
namespace {

NavigatorOptions optionsOf(const Config& config) {
  NavigatorOptions options;
  options.imu = config.imu;
  return options;
}

}  // namespace

InsChain::InsChain(const Config& config, const NavigationState& start, Stamp stamp)
    : filter_(RobustKalmanFilter<kStates>({}), config.parameters, start, stamp, optionsOf(config)),
      ins_(start, stamp, config.imu),
      stop_(stopHere()),
      way_{ins_} {}

ImuVerdict InsChain::add(const ImuReading& reading, std::vector<Audit>& audits, std::vector<Stop>& stops) {
  const ImuStep step = filter_.add(reading);
  if (step.verdict == ImuVerdict::Implausible || step.verdict == ImuVerdict::OutOfOrder) return step.verdict;
  gap_ = step.verdict == ImuVerdict::Bridged ? step.dt : 0;
  // What the filter audited are the first of those that waited, in the order of their stamps.
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [](const Aiding& a, const Aiding& b) { return a.stamp < b.stamp; });
  const auto& audited = filter_.audits();
  for (std::size_t i = 0; i < audited.size(); ++i) {
    if (audited[i].verdict == Verdict::Stale || audited[i].verdict == Verdict::Invalid) {
      audits.push_back(audited[i]);
      continue;
    }
    advance(reading, waiting_[i].stamp);
    if (stop_.stamp != waiting_[i].stamp) cut(stops);
    stop_.readings.push_back(waiting_[i]);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(audited.size()));
  advance(reading, reading.stamp);
  ins_.reset(filter_.fused());
  if (way_.duration > NavigatorOptions().step - 1e-9) cut(stops);
  return step.verdict;
}

void InsChain::advance(const ImuReading& reading, Stamp stamp) {
  const double dt = secondsBetween(ins_.stamp(), stamp);
  ins_.advance(reading, stamp);
  if (!(dt > 0)) return;
  way_.pieces.push_back({reading, stamp});
  way_.duration += dt;
  if (gap_ > 0) way_.gap_variance += gapVariance({}, gap_, dt);
}

/// Ends the way at a new node, and puts the last one out.
void InsChain::cut(std::vector<Stop>& stops) {
  stops.push_back(stop_);
  stop_ = stopHere();
  stop_.way = std::make_shared<const InertialInterval>(std::move(way_));
  way_ = InertialInterval{ins_};
}

void InsChain::close(std::vector<Stop>& stops) {
  if (way_.duration > 0) cut(stops);
  stops.push_back(stop_);
  stop_.readings.clear();
}

InsChain::Stop InsChain::stopHere() const {
  Stop stop;
  stop.stamp = ins_.stamp();
  stop.start = nodeOf(ins_.state(), filter_.belief().mean);
  stop.rate_body = ins_.rate_body();
  return stop;
}

}  // namespace sas_motion::ins
