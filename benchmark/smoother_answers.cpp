// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A smoothing problem with outliers and what rts and batch make of it, as JSON for benchmark/cross_check.py, which
// gives the same to the Python GTSAM. usage: smoother_answers [NODES]
#include <gtsam/linear/GaussianFactorGraph.h>

#include <cstdlib>
#include <ctime>
#include <iostream>
#include <limits>

#include "answer_cases.hpp"
#include "sas_motion/systems/towfish/rts.hpp"
#include "sas_motion/systems/towfish/simulator.hpp"
#include "systems/towfish/graph/batch.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::towfish;
using benchmark::described;
using benchmark::json;
using benchmark::rows;

constexpr MotionParameters kMotion{0.1, 300, 0.2 * kRadPerDeg, 0.02, 0.01};

/// The paper's synchronous case with so many nodes, 10 % of all readings ten times too noisy and the antenna off the
/// centre.
std::vector<Measurement> measurements(int nodes) {
  Scenario scenario;
  scenario.step = 0.1;
  scenario.duration = (nodes - 1) * scenario.step;
  scenario.motion = kMotion;
  const NoiseLaw law{NoiseLaw::Kind::Contaminated, 0.1, 10};
  scenario.sensor(Sensor::Position) = {10, 0, 1, law};
  scenario.sensor(Sensor::Heading) = {10, 0, 0.5 * kRadPerDeg, law};
  scenario.sensor(Sensor::Speed) = {10, 0, 0.05, law};
  scenario.source(Sensor::Position).lever_arm_body << 5, 2;
  std::vector<Measurement> all;
  Simulator simulator(scenario, 1);
  while (simulator.next())
    for (const auto& labelled : simulator.measurements()) all.push_back(labelled.z);
  return all;
}

// The cost, a sum of squares, settles in half as many digits as the states: where it has settled to the last bit, they
// are 1e-6 of a standard deviation from the optimum. So both answers are refined by steps that no longer look at it.
// Re-weighting converges linearly, by a factor of about 5 a step.
constexpr int kRefinements = 20;

std::vector<StateVector> refined(const gtsam::NonlinearFactorGraph& graph, const SmootherResult& result) {
  std::vector<StateVector> states;
  for (const auto& state : result.states) states.push_back(state.mean);
  gtsam::Values values = initialValues(states);
  for (int i = 0; i < kRefinements; ++i) values = values.retract(graph.linearize(values)->optimize());
  for (std::size_t k = 0; k < states.size(); ++k) states[k] = values.at<StateVector>(k);
  return states;
}

std::vector<StateVector> refined(SmoothingProblem problem, const SmootherOptions& options,
                                 const SmootherResult& result) {
  for (std::size_t k = 0; k < problem.nodes(); ++k) problem.initial[k] = result.states[k].mean;
  const double never = -1;
  std::vector<StateVector> states;
  for (const auto& state : smoothRts(problem, {options.loss, kRefinements, never}).states) states.push_back(state.mean);
  return states;
}

template <class Solve, class Refine>
json answer(Solve solve, Refine refine) {
  SmootherResult result;
  double seconds = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < 3; ++repetition) {
    const std::clock_t begin = std::clock();
    result = solve();
    seconds = std::min(seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  json states = json::array(), sigmas = json::array();
  for (const auto& state : refine(result)) states.push_back(rows(state));
  for (const auto& state : result.states) sigmas.push_back(rows(state.covariance.diagonal().cwiseSqrt().eval()));
  return {
      {"states", states}, {"sigmas", sigmas}, {"cost", result.cost}, {"seconds", seconds}, {"failure", result.failure}};
}

json described(const SmoothingProblem& problem) {
  json nodes = json::array();
  for (std::size_t k = 0; k < problem.nodes(); ++k) {
    json node{{"initial", rows(problem.initial[k])}, {"readings", json::array()}};
    if (k > 0)
      node.update({{"dt", problem.dt(k)}, {"turn_rate", problem.inputs[k].turn_rate}, {"Q", rows(problem.Q[k])}});
    for (std::size_t j = problem.first[k]; j < problem.first[k + 1]; ++j) {
      const Measurement& z = problem.measurements[j];
      node["readings"].push_back({{"sensor", sensorName(z.sensor)},
                                  {"value", rows(z.value)},
                                  {"variance", rows(z.variance)},
                                  {"lever_arm", rows(z.lever_arm_body)}});
    }
    nodes.push_back(node);
  }
  return {{"prior", described(problem.prior)},
          {"time_constant", problem.model.parameters().current_time_constant},
          {"nodes", nodes}};
}

}  // namespace

int main(int argc, char** argv) {
  Config config;
  config.model = kMotion;
  const auto problem = buildProblem(measurements(argc > 1 ? std::atoi(argv[1]) : 200), config);
  if (!problem) return EXIT_FAILURE;
  const SmootherOptions options;
  json result = described(*problem);
  result["huber"] = options.loss.tuning();
  result["tolerance"] = options.tolerance;
  result["refinements"] = kRefinements;
  result["rts"] = answer([&] { return smoothRts(*problem, options); },
                         [&](const auto& found) { return refined(*problem, options, found); });
  result["batch"] = answer([&] { return smoothBatch(*problem, options); },
                           [&](const auto& found) { return refined(buildGraph(*problem, options.loss), found); });
  std::cout << result << "\n";
}
