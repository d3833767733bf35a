// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/ins_navigator.hpp"

#include <gtest/gtest.h>

#include "sas_motion/robust/loss.hpp"
#include "support.hpp"

namespace sas_motion::ins {
namespace {

template <class Filter>
using OptionsOf = typename Navigator<Filter>::Options;

/// Runs over a recording; `after` sees the navigator behind each reading of the inertial unit.
template <class Filter, class After>
void run(Navigator<Filter>& navigator, const Recording& recording, const After& after) {
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next) navigator.add(next->reading);
    navigator.add(reading);
    after(navigator);
  }
}

/// RMS of the horizontal position error after the first 120 s [m].
template <class Filter>
double positionError(const Filter& filter, const Scenario& scenario, std::uint64_t seed, const OptionsOf<Filter>& options = {}) {
  const Trajectory trajectory(scenario.track, scenario.duration);
  const Recording recording = simulate(scenario, trajectory, seed);
  Navigator<Filter> navigator(filter, scenario.parameters, recording.start, 0, options);
  double square = 0;
  int count = 0;
  run(navigator, recording, [&](const auto& n) {
    const double time = secondsBetween(0, n.stamp());
    if (time < 120) return;
    square += displacement(trajectory.at(time).state, n.fused()).template head<2>().squaredNorm();
    ++count;
  });
  return std::sqrt(square / count);
}

TEST(InsNavigator, FusesBetterThanGpsAlone) {
  Scenario scenario;
  scenario.duration = 600;
  const double fused = positionError(KalmanFilter<kStates>(), scenario, 1);
  std::cout << "ckf27 " << fused << " m, ins alone " << positionError(Unaided(), scenario, 1) << " m\n";
  EXPECT_LT(fused, 2.8);
}

}  // namespace
}  // namespace sas_motion::ins
