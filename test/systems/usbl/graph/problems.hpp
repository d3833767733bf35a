// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Simulated calibrations for the tests of the factor graph.
#pragma once

#include "sas_motion/systems/usbl/problem.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "support.hpp"

namespace sas_motion::usbl::testing {

/// A figure-eight of `duration` seconds, a tenth of all readings K times too noisy.
inline Scenario figureEight(double duration, double K = 10) {
  Scenario scenario;
  scenario.duration = duration;
  scenario.track.centre = scenario.transponder_map.head<2>();
  scenario.track.radius = scenario.track.speed * duration / (4 * kPi);  // once around both circles
  scenario.noise.fill(sas_motion::testing::contaminated(0.1, K));
  return scenario;
}

inline Problem problemFrom(const std::vector<LabelledPing>& labelled, Mode mode = Mode::DirectionAngles) {
  Problem problem{Model(mode), {}, {}, Vector<kChannels>::Ones()};
  for (const auto& one : labelled) {
    problem.pings.push_back(one.ping);
    problem.pings.back().reading = problem.model.convert(one.ping.reading);
  }
  return problem;
}

inline Problem simulatedProblem(const Scenario& scenario, std::uint64_t seed, Mode mode = Mode::DirectionAngles) {
  std::cout << "seed " << seed << "\n";
  return problemFrom(simulatePings(scenario, seed), mode);
}

inline void estimateAll(Prior& prior) { prior.estimated.fill(true); }

}  // namespace sas_motion::usbl::testing
