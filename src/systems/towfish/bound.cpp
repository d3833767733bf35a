// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "systems/towfish/campaign.hpp"

namespace sas_motion::towfish {
namespace {

/// The information of the readings of each sensor, and of the process noise.
struct Information {
  std::vector<MeasurementInformation> sensors;  // by source
  ProcessInformation process;

  /// Of the rows of one reading, over Gaussian ones.
  Vector<2> factors(const LabelledMeasurement& labelled) const {
    const double time = secondsBetween(Simulator::kStart, labelled.z.stamp);
    const auto& sensor = sensors[static_cast<std::size_t>(sourceOf(labelled.z))];
    return {sensor.of(labelled.variance[0], time), sensor.of(labelled.variance[1], time)};
  }

  /// Whether it is the same in two runs.
  bool alike(const SimulatedRun& a, const SimulatedRun& b) const {
    return !process.genie &&
           std::equal(a.measurements().begin(), a.measurements().end(), b.measurements().begin(),
                      b.measurements().end(), [this](const LabelledMeasurement& x, const LabelledMeasurement& y) {
                        return x.z.stamp == y.z.stamp && x.z.sensor == y.z.sensor && sourceOf(x.z) == sourceOf(y.z) &&
                               factors(x) == factors(y);
                      });
  }
};

Information informationOf(const Scenario& scenario) {
  Information information{{}, processInformation(scenario.process, kStates, scenario.step)};
  for (const auto& sensor : scenario.sources) information.sensors.emplace_back(sensor.noise);
  return information;
}

/// The recursion for the information of one run, with expectations over the truths of all.
class RunBound {
 public:
  RunBound(const Scenario& scenario, const Information& information, const std::vector<SimulatedRun>& runs)
      : model_(scenario.motion), step_(scenario.step), information_(information), runs_(runs) {}

  void follow(const SimulatedRun& run, Stamp from, MeanBound<kStates>& mean) const {
    const double current = 1 / (model_.parameters().current_sigma * model_.parameters().current_sigma);
    PosteriorBound<kStates> bound((StateVector() << 1, 1, current, current, 1, 1).finished().asDiagonal());
    auto next = run.measurements().begin();
    for (std::size_t k = 0; k < run.truth().size(); ++k) {
      const Stamp stamp = Simulator::kStart + static_cast<Stamp>(k) * run.step();
      if (k > 0) predict(bound, run, k);
      for (; next != run.measurements().end() && next->z.stamp == stamp; ++next) update(bound, *next, k);
      if (stamp >= from) mean.add(bound);
    }
  }

 private:
  void predict(PosteriorBound<kStates>& bound, const SimulatedRun& run, std::size_t k) const {
    std::vector<Transition<kStates>> steps;
    for (const auto& other : runs_) {
      steps.push_back(model_.transition(other.truth()[k - 1], Input{}, step_));
      if (information_.process.genie)
        steps.back().Q = covarianceWith<kStates>(steps.back().Q, run.processVariance()[k]);
    }
    bound.step(steps, information_.process.genie ? 1 : information_.process.factor);
  }

  void update(PosteriorBound<kStates>& bound, const LabelledMeasurement& labelled, std::size_t k) const {
    if (rowsOf(labelled.z.sensor) == 2)
      updateRows<2>(bound, labelled, k);
    else if (rowsOf(labelled.z.sensor) == 1)
      updateRows<1>(bound, labelled, k);
  }

  template <int M>
  void updateRows(PosteriorBound<kStates>& bound, const LabelledMeasurement& labelled, std::size_t k) const {
    std::vector<LinearMeasurement<kStates, M>> linear;
    for (const auto& other : runs_)
      model_.linearize(labelled.z, other.truth()[k], [&](const auto& one) {
        if constexpr (std::decay_t<decltype(one)>::kRows == M) linear.push_back(one);
      });
    const Vector<M> factors = information_.factors(labelled).head<M>();
    bound.measurement<M>(linear, std::vector<Vector<M>>(linear.size(), factors));
  }

  Model model_;
  double step_;  // [s]
  const Information& information_;
  const std::vector<SimulatedRun>& runs_;
};

}  // namespace

Named<double> towfishBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds) {
  if (scenario.kind != Scenario::Kind::RandomWalk) return {};
  const Information information = informationOf(scenario);
  std::vector<SimulatedRun> runs;
  runs.reserve(seeds.size());
  for (const auto seed : seeds) runs.emplace_back(scenario, seed);
  const bool once = std::all_of(runs.begin(), runs.end(),
                                [&](const SimulatedRun& run) { return information.alike(runs.front(), run); });
  const RunBound bound(scenario, information, runs);
  MeanBound<kStates> mean;
  for (const auto& run : runs) {
    bound.follow(run, Simulator::kStart + stampFromSeconds(skip), mean);
    if (once) break;
  }
  return mean.rmses({{"position", {kNorth, kEast}},
                     {"heading", {kHeading}},
                     {"speed", {kSpeed}},
                     {"current", {kCurrentNorth, kCurrentEast}}});
}

}  // namespace sas_motion::towfish
