// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// USBL calibration: CPU time of a measurement update of each filter, and of a robust fit of 1,000 pings, native and by
// the factor graph.
#include <benchmark/benchmark.h>

#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "systems/usbl/graph/batch.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::usbl;

/// 1,000 pings on a figure-eight, 10 % of the readings ten times too noisy.
const std::vector<Ping>& pings() {
  static const std::vector<Ping> all = [] {
    Scenario scenario;
    scenario.track.centre = scenario.transponder_map.head<2>();
    scenario.noise.fill(NoiseLaw{NoiseLaw::Kind::Contaminated, 0.1, 10});
    std::vector<Ping> readings;
    for (const auto& labelled : simulatePings(scenario, 1)) readings.push_back(labelled.ping);
    return readings;
  }();
  return all;
}

/// Predict and update of one ping after the other, round and round; no start and no check for lock-in.
void update(benchmark::State& state, const std::string& name) {
  const Config config;
  const CubatureFilter filter(*filterOptions(name, config));
  const Model model;
  const Matrix<kStates> none = Matrix<kStates>::Zero();
  const CubatureFilter::Belief start(Gaussian<kStates>{Scenario::defaultTruth().head<kStates>(),
                                                       config.prior.sigma.head<kStates>().cwiseAbs2().asDiagonal()});
  CubatureFilter::Belief belief = start;
  std::size_t k = 0;
  const auto difference = [&](const Vector<kChannels>& y, const Vector<kChannels>& x) {
    return model.difference(y, x);
  };
  for (auto unused : state) {
    (void)unused;
    const Ping& ping = pings()[k];
    k = (k + 1) % pings().size();
    if (k == 0) belief = start;
    const auto h = [&](const State& x) { return model.predict(x, ping); };
    belief = filter
                 .update(filter.predict(belief, none), ping.reading.value, ping.reading.variance,
                         Vector<kChannels>::Ones(), h, difference)
                 .belief;
    benchmark::DoNotOptimize(belief);
  }
}

void robustFit(benchmark::State& state, const Fitter& fitter) {
  Problem problem;
  problem.pings = pings();
  for (auto unused : state) {
    (void)unused;
    const Fit fit = fitter(problem, FitOptions());
    if (!fit.failure.empty()) state.SkipWithError(fit.failure.c_str());
    benchmark::DoNotOptimize(fit);
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const auto& name : filterNames())
    benchmark::RegisterBenchmark((name + ", an update").c_str(),
                                 [name](benchmark::State& state) { update(state, name); });
  const auto native = [](const Problem& problem, const FitOptions& options) { return fit(problem, options); };
  const auto add = [](const char* name, const Fitter& fitter) {
    benchmark::RegisterBenchmark(name, [fitter](benchmark::State& state) {
      robustFit(state, fitter);
    })->Unit(benchmark::kMillisecond);
  };
  add("native fit of 1,000 pings", native);
  add("batch of 1,000 pings", makeFitter("batch"));
  add("gnc of 1,000 pings", makeFitter("gnc"));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
