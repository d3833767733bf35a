// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// rts and batch on the same problems: cost, states and time, from a thousand nodes up. usage: smoother_speed
// [LARGEST_NODES]
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>

#include "sas_motion/systems/towfish/rts.hpp"
#include "sas_motion/systems/towfish/simulator.hpp"
#include "systems/towfish/graph/batch.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::towfish;

/// The paper's synchronous case, 10 % of all readings ten times too noisy, so many nodes long.
std::vector<Measurement> measurements(int nodes, std::uint64_t seed) {
  Scenario scenario;
  scenario.step = 0.1;
  scenario.duration = (nodes - 1) * scenario.step;
  scenario.motion = {0.1, 300, 0.2 * kRadPerDeg, 0.02, 0.01};
  const std::map<Sensor, double> sigmas{
      {Sensor::Position, 1}, {Sensor::Heading, 0.5 * kRadPerDeg}, {Sensor::Speed, 0.05}};
  for (const auto& [sensor, sigma] : sigmas)
    scenario.sensor(sensor) = {10, 0, sigma, NoiseLaw{NoiseLaw::Kind::Contaminated, 0.1, 10}};
  std::vector<Measurement> all;
  Simulator simulator(scenario, seed);
  while (simulator.next())
    for (const auto& labelled : simulator.measurements()) all.push_back(labelled.z);
  return all;
}

template <class Solve>
double seconds(Solve solve) {
  const auto begin = std::chrono::steady_clock::now();
  solve();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The largest difference of any state in units of its standard deviation.
double largestDifference(const SmootherResult& a, const SmootherResult& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    const StateVector d = Model::difference(a.states[k].mean, b.states[k].mean).cwiseAbs();
    largest = std::max(largest, d.cwiseQuotient(b.states[k].covariance.diagonal().cwiseSqrt()).maxCoeff());
  }
  return largest;
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 100000;
  Config config;
  config.model = {0.1, 300, 0.2 * kRadPerDeg, 0.02, 0.01};
  fmt::print("{:>8}{:>10}{:>10}{:>8}{:>12}{:>12}{:>16}{:>18}{:>16}{:>8}{:>8}\n", "nodes", "rts [s]", "batch [s]",
             "ratio", "rts us/node", "batch us/node", "us/node/iter", "cost difference", "states [sigma]", "iter",
             "iter");
  for (int nodes = 1000; nodes <= largest; nodes *= 10) {
    const auto problem = buildProblem(measurements(nodes, 1), config);
    SmootherResult native, graph;
    const double rts = seconds([&] { native = smoothRts(*problem, config.rts); });
    const double batch = seconds([&] { graph = smoothBatch(*problem, config.batch); });
    if (!graph.failure.empty()) fmt::print("batch: {}\n", graph.failure);
    fmt::print("{:>8}{:>10.4f}{:>10.3f}{:>8.1f}{:>12.2f}{:>13.1f}{:>16.2f}{:>18.1e}{:>16.1e}{:>8}{:>8}\n", nodes, rts,
               batch, batch / rts, 1e6 * rts / nodes, 1e6 * batch / nodes, 1e6 * rts / nodes / native.iterations,
               std::abs(native.cost - graph.cost) / graph.cost, largestDifference(native, graph), native.iterations,
               graph.iterations);
  }
}
